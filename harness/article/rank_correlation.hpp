/// Rank correlation of two lists of numbers.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

namespace loopbench::harness {

/// Spearman's rank correlation; equal values are ranked in the order given. NaN for fewer than
/// three pairs. Both lists have the same length. O(n log n).
inline double rank_correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const auto ranks = [](const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return values[i]; });
    std::vector<double> out(values.size());
    for (std::size_t i = 0; i < order.size(); ++i) out[order[i]] = static_cast<double>(i);
    return out;
  };
  const std::vector<double> a = ranks(x), b = ranks(y);
  const double n = static_cast<double>(a.size());
  if (n < 3.0) return std::numeric_limits<double>::quiet_NaN();
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
  return 1.0 - 6.0 * squares / (n * (n * n - 1.0));
}

}  // namespace loopbench::harness
