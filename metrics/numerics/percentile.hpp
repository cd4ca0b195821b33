/// Percentiles of a list.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace loopbench::metrics {

/// The value at `share` (0..1) of a sorted list that is not empty, interpolated linearly between
/// neighbours (numpy's default).
inline double percentile(const std::vector<double>& sorted, double share) {
  const double rank = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], rank - static_cast<double>(below));
}

}  // namespace loopbench::metrics
