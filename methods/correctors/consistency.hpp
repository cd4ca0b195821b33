/// Which loop closures agree with one another: a check before any correction.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "datasets/core/fields.hpp"
#include "datasets/core/problem.hpp"

namespace loopbench {

struct Consistency {
  std::optional<double> chi2 = std::nullopt;
  double odometry_scale = 1.0;
  std::int64_t most_steps = 100000;
  std::int64_t max_closures = 1500;
};

template <class Visit>
void consistency_fields(Consistency& o, Visit visit) {
  visit("pcm.chi2",
        o.chi2,
        "largest squared error of a loop through two closures [-]; none: 99 % quantile",
        Above{0.0});
  visit("pcm.odometry_scale",
        o.odometry_scale,
        "on odometry's standard deviations: above 1 where drift is systematic [-]",
        Above{0.0});
  visit("pcm.most_steps", o.most_steps, "of the exact clique search, greedy beyond", Between{0});
  visit("pcm.max_closures", o.max_closures, "declines above: all pairs are tried", Between{1});
}

/// Two closures a -> b and c -> d agree when the loop through both,
///     E = L_ab^-1 O_ac L_cd O_db   (O: odometry, either way),
/// is the identity as far as its covariance lets it: Log(E)' S^-1 Log(E) < chi2. S is carried along
/// to first order, odometry that is walked twice counted once with its sign; it costs O(1) by
/// prefix sums over the chain.
struct PairError {
  Twist error;
  Matrix6 covariance;
};
PairError pair_error(const Problem& problem, const Edge& first, const Edge& second);

struct ConsistentClosures {
  std::vector<std::size_t> kept;  ///< ascending
  bool is_largest = false;        ///< proved the largest set
};

/// The largest set of closures that all agree with one another (PCM). A closure that no other
/// agrees with is dropped, unless it is the only one. Needs whole odometry: see chain_fault().
/// O(n + K^2) and a clique search.
/// Source: Mangelson, Dominic, Eustice, Vasudevan, Pairwise consistent measurement set
/// maximization, ICRA 2018.
ConsistentClosures consistent_closures(const Problem& problem, const Consistency& options);

}  // namespace loopbench
