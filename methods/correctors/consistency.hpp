/// Pairwise consistency check of loop closures before any correction.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "datasets/core/fields.hpp"
#include "datasets/core/problem.hpp"

namespace loopbench::methods {

struct ConsistencyOptions {
  std::optional<double> chi2 = std::nullopt;
  double odometry_scale = 1.0;
  std::int64_t max_steps = 100000;
  std::int64_t max_closures = 1500;
};

template <class Visit>
void consistency_fields(ConsistencyOptions& o, Visit visit) {
  visit("pcm.chi2",
        o.chi2,
        "maximum squared Mahalanobis error of a loop through two closures [-]; none: 99 % quantile",
        GreaterThan{0.0});
  visit("pcm.odometry_scale",
        o.odometry_scale,
        "factor on the odometry's standard deviations, above 1 for systematic drift [-]",
        GreaterThan{0.0});
  visit("pcm.most_steps",
        o.max_steps,
        "maximum number of steps of the exact clique search; above it the best clique found so far "
        "is used",
        Between{0});
  visit("pcm.max_closures",
        o.max_closures,
        "maximum number of closures; all pairs are compared",
        Between{1});
}

/// Residual and covariance of the loop through two closures a -> b and c -> d,
///     E = L_ab^-1 O_ac L_cd O_db   (O: odometry, in either direction).
/// The closures are consistent when Log(E)' S^-1 Log(E) < chi2. The covariance S is propagated to
/// first order; odometry that is traversed twice enters once, with its sign. O(1) per pair with
/// prefix sums over the chain.
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
/// no other is dropped, unless it is the only one. Requires complete odometry: see chain_fault().
/// O(n + K^2) plus a clique search. Source: Mangelson, Dominic, Eustice, Vasudevan, Pairwise
/// consistent measurement set maximization, ICRA 2018.
ConsistentClosures consistent_closures(const Problem& problem, const ConsistencyOptions& options);

}  // namespace loopbench::methods
