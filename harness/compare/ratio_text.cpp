#include "harness/compare/ratio_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace loopbench::harness {
namespace {

/// One decimal, or two digits if that would be 0.0.
std::string percent_text(double percent) {
  return std::abs(percent) >= 0.95 || percent == 0.0 ? fmt::format("{:.1f}", percent + 0.0)
                                                     : fmt::format("{:.2g}", percent);
}

/// Whether the second value is better than the first by more than a relevant difference.
bool is_gain(double ratio, const Comparison& c) {
  const double gain = c.kind.better == metrics::Better::higher ? std::log(ratio) : -std::log(ratio);
  return gain > std::log1p(c.options.relevant);
}

}  // namespace

std::string joined_names(const std::vector<std::string>& names, const char* last) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    out += (i == 0 ? "" : i + 1 == names.size() ? last : ", ") + names[i];
  }
  return out;
}

std::string ratio_text(const Ratio& ratio, const std::string& other, const Comparison& c) {
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

std::string sequences_text(const Ratio& ratio, const Comparison& c) {
  std::vector<std::string> better;
  std::vector<std::string> worse;
  for (const auto& [sequence, value] : ratio.by_sequence) {
    if (is_gain(value, c)) better.push_back(sequence);
    if (is_gain(1.0 / value, c)) worse.push_back(sequence);
  }
  const auto listed = [&](const std::vector<std::string>& names) {
    return names.size() <= 3 ? joined_names(names)
                             : fmt::format("{} of {} sequences", names.size(), c.sequences);
  };
  if (is_gain(1.0 / ratio.typical.estimate, c)) {
    return better.empty() ? "" : ", but better on " + listed(better);
  }
  if (!worse.empty()) return ", but worse on " + listed(worse);
  const bool is_everywhere = better.empty() || better.size() == ratio.by_sequence.size();
  return is_everywhere ? "" : ", all of it on " + listed(better);
}

}  // namespace loopbench::harness
