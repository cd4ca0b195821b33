/// Stamps as text: seconds with decimals, or whole nanoseconds.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace loopbench {

/// The number in a column of stamps, also as the name of an image: 1.5 of `1.5`, `1.5.png` and
/// `rgb/left_1.5.png`. Empty if there is none.
std::string_view stamp_word(std::string_view column);

/// The value of stamp_word(); not finite for a stamp such as nan.
std::optional<double> stamp_number(std::string_view column);

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
