/// Data for the report's figures, as JSON.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "harness/answers/report/report.hpp"
#include "harness/sweep/model/trace.hpp"

namespace loopbench::harness {

/// {methods, styles, default_methods, oracle, stated, stated_note, sequences, baseline, statistics,
/// kinds, sequence_families, method_families, growth, cells}: every score of every cell to five
/// digits. styles: {color, dash} of each method as in `plot`; default_methods: indices of the
/// methods that are shown first. A cell is {sequence, method, repeat, ms, values}: indices of its
/// sequence and method, repeat, time [ms], and for each kind null or its statistics.
nlohmann::json scores_json(const ReportContent& content);

/// Amount of trace data in the report.
struct Thinning {
  double deviation = kTraceDeviation;  ///< of curves, in shares of their figures
  std::size_t repeats = 1;             ///< of each sequence, the first ones

  bool operator==(const Thinning&) const = default;
};

/// Bytes on the page of the traces of the first, second, ... repeats of all shown sequences.
std::vector<double> trace_bytes(const ReportContent& content);

/// As much as takes about `bytes`: as many repeats as fit (see trace_bytes()) with curves as in the
/// store; if one does not fit, coarser curves. The least amount is that for zero bytes.
Thinning thinning_for(const std::vector<double>& repeats, double bytes);

/// {sequences, cells} from the traces, poses and values as base64 of packed columns
/// (harness/sweep/model/packed_columns.hpp). Sequences: path of the reference, and for each repeat
/// closures, with stored_ledger() and the keyframes before correction if there is one. Cells:
/// samples, evaluation times, values of metrics and sections of the path.
nlohmann::json traces_json(const ReportContent& content, const Thinning& thinning);

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

}  // namespace loopbench::harness
