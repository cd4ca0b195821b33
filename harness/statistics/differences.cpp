#include "harness/statistics/differences.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "harness/statistics/ranks.hpp"

namespace loopbench::harness {

Differences paired_differences(std::span<const double> values,
                               std::span<const double> baseline,
                               double tie) {
  if (values.size() != baseline.size()) throw std::invalid_argument("paired lists differ in size");
  const auto positive = [](double value) { return value > 0.0; };
  Differences out;
  out.is_ratio = std::ranges::all_of(values, positive) && std::ranges::all_of(baseline, positive);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (tied(values[i], baseline[i], tie)) {
      out.values.push_back(0.0);
    } else {
      out.values.push_back(out.is_ratio ? std::log(values[i] / baseline[i])
                                        : values[i] - baseline[i]);
    }
  }
  return out;
}

}  // namespace loopbench::harness
