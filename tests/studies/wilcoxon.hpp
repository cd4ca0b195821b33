/// Wilcoxon's signed-rank test, to compare the power of verdicts with it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace loopbench::synthetic {

/// Exact two-sided p of differences without ties. O(n^3).
inline double wilcoxon_p(std::vector<double> differences) {
  std::ranges::sort(differences, {}, [](double d) { return std::abs(d); });
  const std::size_t n = differences.size();
  std::size_t negative = 0;
  std::vector<double> chance(n * (n + 1) / 2 + 1, 0.0);  // of each sum of ranks
  chance[0] = 1.0;
  for (std::size_t rank = 1; rank <= n; ++rank) {
    negative += differences[rank - 1] < 0.0 ? rank : 0;
    for (std::size_t sum = chance.size(); sum-- > 0;)
      chance[sum] = 0.5 * (chance[sum] + (sum >= rank ? chance[sum - rank] : 0.0));
  }
  const std::size_t less = std::min(negative, chance.size() - 1 - negative);
  return std::min(
      1.0, 2.0 * std::accumulate(chance.begin(), chance.begin() + std::ptrdiff_t(less) + 1, 0.0));
}

}  // namespace loopbench::synthetic
