/// Two values of the same run, laid against each other.
#pragma once

#include <span>
#include <vector>

namespace loopbench {

/// Relative difference below which two errors are the same number computed in another order, not a
/// better and a worse one.
inline constexpr double kTie = 1e-9;

struct Differences {
  std::vector<double> values;  ///< negative: lower than the baseline; ties are exactly 0
  bool is_ratio = false;       ///< they are logarithms of value / baseline
};

/// Logarithms of ratios where all values are positive, so that a run with errors of metres does not
/// drown one with errors of centimetres; plain differences otherwise. The spans have one length
/// (std::invalid_argument). O(n).
Differences paired_differences(std::span<const double> values,
                               std::span<const double> baseline,
                               double tie = kTie);

}  // namespace loopbench
