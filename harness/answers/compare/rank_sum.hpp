/// Wilcoxon's rank-sum test of two independent samples within strata.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "harness/answers/compare/signed_rank.hpp"

namespace loopbench::harness {

/// Sizes of the two samples in one stratum.
struct Stratum {
  std::size_t first = 0;
  std::size_t second = 0;

  std::size_t pairs() const { return first * second; }
};

inline std::size_t count_pairs(std::span<const Stratum> strata) {
  std::size_t out = 0;
  for (const Stratum& one : strata) out += one.pairs();
  return out;
}

/// P(U <= u) for equally distributed samples without ties. U is the number of pairs (one value of
/// either sample in the same stratum) whose first value is the larger one (Mann and Whitney, 1947).
/// Exact for up to some thousand pairs, beyond by the normal approximation. `u` up to half of the
/// pairs. O(values * u) if exact.
inline double rank_sum_tail(std::span<const Stratum> strata, std::size_t u) {
  constexpr std::size_t kMostExactPairs = 5000;
  if (const std::size_t pairs = count_pairs(strata); pairs > kMostExactPairs) {
    double variance = 0.0;
    for (const Stratum& one : strata) {
      variance += static_cast<double>(one.pairs() * (one.first + one.second + 1)) / 12.0;
    }
    const double center = 0.5 * static_cast<double>(pairs);
    return normal_cdf((static_cast<double>(u) + 0.5 - center) / std::sqrt(variance));
  }
  // The generating function of U is a product of Gaussian binomials, of which one is the product
  // over i = 1..m of (1 - q^(n + i)) / (1 - q^i), for samples of m and n.
  std::vector<double> chance(u + 1, 0.0);
  chance[0] = 1.0;
  for (const Stratum& one : strata) {
    const std::size_t fewer = std::min(one.first, one.second);
    const std::size_t more = std::max(one.first, one.second);
    for (std::size_t i = 1; i <= fewer; ++i) {
      for (std::size_t at = u + 1; at-- > more + i;) chance[at] -= chance[at - more - i];
      for (std::size_t at = i; at <= u; ++at) chance[at] += chance[at - i];
      const double share = static_cast<double>(i) / static_cast<double>(more + i);
      for (double& one_chance : chance) one_chance *= share;
    }
  }
  return std::accumulate(chance.begin(), chance.end(), 0.0);
}

/// The largest c with 2 P(U <= c) <= alpha; nullopt if there is none.
inline std::optional<std::size_t> critical_pairs(std::span<const Stratum> strata, double alpha) {
  return largest_rejected(
      count_pairs(strata) / 2, alpha, [&](std::size_t u) { return rank_sum_tail(strata, u); });
}

}  // namespace loopbench::harness
