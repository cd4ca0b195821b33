/// Stamps as text: seconds with decimals, or whole nanoseconds.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace loopbench {

/// Whether a stamp is so large that it cannot be in seconds (1e16: 1970 + 115 days in nanoseconds)
/// and fits into 64 bits of nanoseconds (9e18: + 285 years).
inline bool is_in_nanoseconds(double stamp, bool small_nanoseconds) {
  return stamp <= 9e18 && (stamp >= 1e16 || small_nanoseconds);
}

/// Exact nanoseconds of a decimal number of 10^exponent seconds, also in the form 1.3e+09. Nothing
/// if it is no whole number of nanoseconds or does not fit into 64 bits.
std::optional<std::int64_t> exact_nanoseconds(std::string_view number, int exponent = 0);

struct ReadStamp {
  double seconds = 0.0;
  std::optional<std::int64_t> exact = {};  ///< [ns]
};

/// The stamp `word`, whose parsed value is `number`, in units of 10^exponent seconds.
ReadStamp read_stamp(std::string_view word, double number, int exponent);

/// Converts to [s]. Seconds and remainder are converted separately, because nanoseconds since 1970
/// exceed 53 bits.
double seconds_of(std::int64_t nanoseconds);

/// Shortest decimal number of seconds: 1305031102.1753.
std::string seconds_text(std::int64_t nanoseconds);

}  // namespace loopbench
