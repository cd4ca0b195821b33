/// Check of closures against the joint solution of all that agree.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <vector>

#include "methods/correctors/consensus/agreeing_loops.hpp"
#include "methods/correctors/consensus/judgement.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "methods/solvers/left_out_closures.hpp"

namespace loopbench::methods::consensus {

/// Factor on the closures' variance by all that agree: mean of their squared errors over that of
/// their redundancies, with errors bounded where false ones may be among them.
template <class G>
double closure_variance_factor(const std::vector<std::optional<LeftOut<G>>>& closures) {
  constexpr double kBound = 4.0;  // of a squared error over its expected value
  double squared = 0.0, expected = 0.0;
  for (const std::optional<LeftOut<G>>& each : closures) {
    if (!each) continue;
    squared += std::min(each->squared, kBound * each->redundancy);
    expected += each->redundancy;
  }
  return expected > 0.0 ? squared / expected : 1.0;
}

/// Log odds of an outlier over a true closure.
template <class G>
double outlier_odds(const LeftOut<G>& without, const Edge& closure, double log_uniform) {
  const typename G::Square own = inverse_of(G::information(closure, 1.0));
  typename G::Square own_translation = G::Square::Zero();
  constexpr int kFirst = kTranslation<G>;
  own_translation.template topLeftCorner<kFirst, kFirst>() =
      own.template topLeftCorner<kFirst, kFirst>();
  const double outlier = outlier_density<typename G::Tangent, typename G::Square>(
      without.error, without.covariance, own, own_translation, log_uniform);
  return outlier - normal_density(without.error, without.covariance).log_density;
}

/// Empty: the solver found no solution.
inline Trajectory solved_roughly(const Problem& agreed) {
  PoseGraphOptimizer::Options options;
  options.start = PoseGraphOptimizer::Start::chordal;
  options.max_iterations = 50;
  options.tolerance = 1e-6;
  Report unused;
  try {
    return PoseGraphOptimizer(options).correct(agreed, unused);
  } catch (const std::runtime_error&) {
    return {};
  }
}

/// Each closure left out; empty if the information of some edges is not positive definite.
template <class G>
std::vector<std::optional<LeftOut<G>>> left_out_each(const std::vector<ScaledPose>& poses,
                                                     const Problem& agreed) {
  try {
    return left_out_closures<G>(poses, agreed);
  } catch (const std::runtime_error&) {
    return {};
  }
}

/// Drops closures that were only compared with the core and contradict others: in the solution
/// with all that agree, those that are likelier outliers given all others, the worst first.
template <class G>
void drop_inconsistent(const Problem& problem, double log_uniform, ClosureJudgement& judgement) {
  constexpr int kRounds = 6;
  for (int round = 0; round < kRounds; ++round) {
    const Problem agreed = agreed_problem(problem, judgement);
    std::vector<ScaledPose> poses;
    for (const StampedPose& each : solved_roughly(agreed))
      poses.push_back({each.world_from_body, 1.0});
    if (poses.empty() || agreed.closures.empty()) return;
    const auto without = left_out_each<G>(poses, agreed);
    if (without.empty()) return;
    if (round == 0) judgement.factors.closures *= std::sqrt(closure_variance_factor(without));
    std::vector<double> log_odds;  // of an outlier
    for (std::size_t k = 0; k < without.size(); ++k) {
      log_odds.push_back(without[k] ? outlier_odds(*without[k], agreed.closures[k], log_uniform)
                                    : 0.0);
    }
    const double limit = std::max(0.0, 0.3 * *std::ranges::max_element(log_odds));
    std::size_t next = 0;
    bool is_consistent = true;
    for (JudgedClosure& each : judgement.closures) {
      if (each.finding != ClosureFinding::agrees || !(log_odds[next++] > limit)) continue;
      each.finding = ClosureFinding::contradicts;
      is_consistent = false;
    }
    if (is_consistent) return;
  }
}

}  // namespace loopbench::methods::consensus
