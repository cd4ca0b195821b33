/// Ranks with ties.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

namespace loopbench::harness {

/// Relative difference up to which two errors count as equal: smaller ones are due to rounding,
/// summation order or solver, for any p value.
inline constexpr double kTieShare = 1e-6;

/// Whether |a - b| <= tie * max(|a|, |b|).
inline bool tied(double a, double b, double tie) {
  return std::abs(a - b) <= tie * std::max(std::abs(a), std::abs(b));
}

/// 1 for the smallest; ties get the mean of their ranks. Neighbouring values that are `tied` share
/// a rank, also in chains; 0 ties only equal values. No NaN. O(n log n).
inline std::vector<double> midranks(std::span<const double> values, double tie = 0.0) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
  std::vector<double> ranks(values.size());
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    end = begin + 1;
    while (end < order.size() && tied(values[order[end - 1]], values[order[end]], tie)) ++end;
    const double shared = 0.5 * static_cast<double>(begin + 1 + end);
    for (std::size_t i = begin; i < end; ++i) ranks[order[i]] = shared;
  }
  return ranks;
}

}  // namespace loopbench::harness
