/// Ranks with ties.
#pragma once

#include <span>
#include <vector>

namespace loopbench::harness {

/// Relative difference up to which two errors count as equal: smaller ones are due to rounding,
/// summation order or solver, for any p value.
inline constexpr double kTieShare = 1e-6;

/// Whether |a - b| <= tie * max(|a|, |b|).
bool tied(double a, double b, double tie);

/// 1 for the smallest; ties get the mean of their ranks. Neighbouring values that are `tied` share
/// a rank, also in chains; 0 ties only equal values. No NaN. O(n log n).
std::vector<double> midranks(std::span<const double> values, double tie = 0.0);

}  // namespace loopbench::harness
