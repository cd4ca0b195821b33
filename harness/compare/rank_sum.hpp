/// Wilcoxon's rank-sum test of two independent samples within strata.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace loopbench::harness {

/// Sizes of the two samples in one stratum.
struct Stratum {
  std::size_t first = 0;
  std::size_t second = 0;

  std::size_t pairs() const { return first * second; }
};

/// P(U <= u) for equally distributed samples without ties. U is the number of pairs (one value of
/// either sample in the same stratum) whose first value is the larger one (Mann and Whitney, 1947).
/// Exact for up to some thousand pairs, beyond by the normal approximation. `u` up to half of the
/// pairs. O(values * u) if exact.
double rank_sum_tail(std::span<const Stratum> strata, std::size_t u);

/// The largest c with 2 P(U <= c) <= alpha; nullopt if there is none.
std::optional<std::size_t> critical_pairs(std::span<const Stratum> strata, double alpha);

}  // namespace loopbench::harness
