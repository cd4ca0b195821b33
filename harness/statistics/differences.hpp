/// Paired differences between two lists of values.
#pragma once

#include <span>
#include <vector>

namespace loopbench::harness {

/// Relative difference below which two errors count as the same number computed in another order.
inline constexpr double kTie = 1e-9;

struct Differences {
  std::vector<double> values;  ///< negative: lower than the baseline; ties are exactly 0
  bool is_ratio = false;       ///< values are logarithms of value / baseline
};

/// Log ratios if all values are positive, so that runs with errors of metres do not dominate runs
/// with errors of centimetres; otherwise plain differences. The spans must have equal length
/// (std::invalid_argument). O(n).
Differences paired_differences(std::span<const double> values,
                               std::span<const double> baseline,
                               double tie = kTie);

}  // namespace loopbench::harness
