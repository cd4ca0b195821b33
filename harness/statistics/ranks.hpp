/// Ranks in which equals share.
#pragma once

#include <span>
#include <vector>

namespace loopbench {

/// Relative difference up to which two errors count as equal: less is rounding, another order of
/// summation or another solver, whatever its p.
inline constexpr double kRelevant = 1e-6;

/// Whether |a - b| <= tie * max(|a|, |b|).
bool tied(double a, double b, double tie);

/// 1 for the smallest; ties get the mean of the ranks they span. Neighbours in order that are
/// `tied` share, and so do chains of them; 0 ties only equals. No NaN. O(n log n).
std::vector<double> midranks(std::span<const double> values, double tie = 0.0);

}  // namespace loopbench
