/// Compact encoding of columns of numbers.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace loopbench::harness {

/// Base64 of RFC 4648, with padding.
inline std::string base64(std::string_view bytes) {
  constexpr const char* kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool inside = i + k < bytes.size();
      group = group << 8U | (inside ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += i + k > bytes.size() ? '=' : kLetters[group >> (18U - 6U * k) & 63U];
    }
  }
  return out;
}

/// The number to `digits` digits; null unless it is finite.
inline nlohmann::json rounded_number(double value, int digits) {
  if (!std::isfinite(value)) return nullptr;
  return std::stod(fmt::format("{:.{}g}", value, digits));
}

/// The JSON object {low, step, words}: value = low + step * word, 16-bit little-endian words in
/// base64; 65535 is NaN. The error is at most half a step: 1/131068 of the range, far below a
/// pixel.
inline nlohmann::json packed(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) low = high = 0.0;
  const double step = high > low ? (high - low) / 65534.0 : 1.0;
  std::string bytes;
  for (const double value : values) {
    const auto word = std::isfinite(value)
                          ? static_cast<std::uint32_t>(std::lround((value - low) / step))
                          : 65535U;
    bytes += static_cast<char>(word & 255U);
    bytes += static_cast<char>(word >> 8U);
  }
  constexpr int kDigits = 7;
  return {{"low", rounded_number(low, kDigits)},
          {"step", rounded_number(step, kDigits)},
          {"words", base64(bytes)}};
}

/// At most `most` evenly spaced indices of 0..count-1, including both ends.
inline std::vector<std::size_t> subsampled_indices(std::size_t count, std::size_t most) {
  const std::size_t kept = std::min(count, most);
  std::vector<std::size_t> out(kept);
  for (std::size_t i = 0; i < kept; ++i) out[i] = kept == 1 ? 0 : i * (count - 1) / (kept - 1);
  return out;
}

}  // namespace loopbench::harness
