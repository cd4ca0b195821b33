/// Compact encoding of columns of numbers.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace loopbench::harness {

/// Base64 of RFC 4648, with padding.
std::string base64(std::string_view bytes);

/// The JSON object {low, step, words}: value = low + step * word, 16-bit little-endian words in
/// base64; 65535 is NaN. The error is at most half a step: 1/131068 of the range, far below a
/// pixel.
nlohmann::json packed(const std::vector<double>& values);

/// The number to `digits` digits; null unless it is finite.
nlohmann::json rounded_number(double value, int digits);

/// At most `most` evenly spaced indices of 0..count-1, including both ends.
std::vector<std::size_t> subsampled_indices(std::size_t count, std::size_t most);

}  // namespace loopbench::harness
