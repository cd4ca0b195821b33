/// Parts of verdicts: ratios in words.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "harness/compare/compare.hpp"

namespace loopbench::harness {

/// "12.3 % below raw [8.1, 15.2], p = 0.02": the difference of a method to the baseline.
std::string result_text(const Comparison& c, const MethodVerdict& method);

/// "5 runs cannot show a difference among 2 methods at 0.05 (6 are needed)".
std::string cannot_show_text(const Comparison& c);

/// One decimal, or two digits if that would be 0.0.
inline std::string percent_text(double percent) {
  return std::abs(percent) >= 0.95 || percent == 0.0 ? fmt::format("{:.1f}", percent + 0.0)
                                                     : fmt::format("{:.2g}", percent);
}

/// Whether a ratio is better than 1 by more than a relevant difference.
inline bool is_gain(double ratio, const Comparison& c) {
  const double gain = c.kind.better == metrics::Better::higher ? std::log(ratio) : -std::log(ratio);
  return gain > std::log1p(c.options.relevant);
}

/// "a, b and c"; of more than four names the first three and "5 others".
inline std::string joined_names(std::vector<std::string> names, const char* last = " and ") {
  constexpr std::size_t kMost = 4;
  if (names.size() > kMost) {
    names[kMost - 1] = fmt::format("{} others", names.size() - (kMost - 1));
    names.resize(kMost);
  }
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    out += (i == 0 ? "" : i + 1 == names.size() ? last : ", ") + names[i];
  }
  return out;
}

/// "12.3 % below raw [8.1, 15.2]", for a score with a target "12.3 % closer to 1 than raw".
inline std::string ratio_text(const Ratio& ratio, const std::string& other, const Comparison& c) {
  const double sign = ratio.typical.estimate <= 1.0 ? -100.0 : 100.0;
  const auto percent = [&](double value) { return sign * (value - 1.0); };
  const bool has_target = c.kind.better == metrics::Better::target;
  const std::string relation =
      !has_target
          ? (sign < 0.0 ? "below" : "above")
          : fmt::format("{} {:g} than", sign < 0.0 ? "closer to" : "farther from", c.kind.target);
  std::string out =
      fmt::format("{} % {} {}", percent_text(percent(ratio.typical.estimate)), relation, other);
  if (ratio.has_interval) {
    const double low = percent(ratio.typical.low);
    const double high = percent(ratio.typical.high);
    out += fmt::format(
        " [{}, {}]", percent_text(std::min(low, high)), percent_text(std::max(low, high)));
  }
  return out;
}

/// ", all of it on sparse (20.0 %)", ", but worse on city": what a ratio hides.
inline std::string sequences_text(const Ratio& ratio, const Comparison& c) {
  std::vector<std::string> better;
  std::vector<std::string> worse;
  for (const SequenceRatio& one : ratio.by_sequence) {
    const std::string named =
        fmt::format("{} ({} %)", one.sequence, percent_text(100.0 * std::abs(one.ratio - 1.0)));
    if (one.is_clear && is_gain(one.ratio, c)) better.push_back(named);
    if (one.is_clear && is_gain(1.0 / one.ratio, c)) worse.push_back(named);
  }
  const bool is_worse = is_gain(1.0 / ratio.typical.estimate, c);
  if (is_worse) std::swap(better, worse);
  if (!worse.empty())
    return (is_worse ? ", but better on " : ", but worse on ") + joined_names(worse);
  const bool is_everywhere = better.empty() || better.size() == ratio.by_sequence.size();
  return is_everywhere ? "" : ", all of it on " + joined_names(better);
}

}  // namespace loopbench::harness
