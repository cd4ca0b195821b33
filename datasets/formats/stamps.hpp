/// Stamps as text: seconds with decimals, or whole nanoseconds.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace loopbench {

/// Converts a stamp column to [s], where `number` is its parsed value. Nanoseconds, as written by
/// ORB-SLAM3, are whole numbers or have zero decimals; they are 1e16 or more, or smaller with
/// `small_nanoseconds`.
double seconds_of_stamp(std::string_view word, double number, bool small_nanoseconds);

/// Exact nanoseconds of a decimal number of seconds, also in the form 1.3e+09. Nothing if it has
/// more than nine decimals or does not fit into 64 bits.
std::optional<std::int64_t> exact_nanoseconds(std::string_view seconds);

/// Shortest decimal number of seconds: 1305031102.1753.
std::string seconds_text(std::int64_t nanoseconds);

}  // namespace loopbench
