/// Pairwise consistency check of loop closures before any correction.
#pragma once

#include <cstdint>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench::methods {

/// Default of the largest number of closures of which all pairs are compared.
inline constexpr std::int64_t kMaxComparedClosures = 1500;

/// Residual and covariance of the loop through two closures a -> b and c -> d,
///     E = L_ab^-1 O_ac L_cd O_db   (O: odometry, in either direction).
/// The closures are consistent when Log(E)' S^-1 Log(E) is below its 99 % quantile. The covariance
/// S is propagated to first order; odometry that is traversed twice enters once, with its sign.
/// O(1) per pair with prefix sums over the chain.
struct PairError {
  Twist error;
  Matrix6 covariance;
};
PairError pair_error(const Problem& problem, const Edge& first, const Edge& second);

struct ConsistentClosures {
  std::vector<std::size_t> kept;  ///< ascending
  bool is_largest = false;        ///< the set is proved to be the largest
};

/// Returns the largest set of pairwise consistent closures (PCM). A closure that is consistent with
/// no other is dropped, unless it is the only one. Requires complete odometry: see why_no_chain().
/// O(n + K^2) plus a clique search. Source: Mangelson, Dominic, Eustice, Vasudevan, Pairwise
/// consistent measurement set maximization, ICRA 2018.
ConsistentClosures consistent_closures(const Problem& problem);

}  // namespace loopbench::methods
