/// How well a method predicts the closures of a place from those of all others.
#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "datasets/core/closure_places.hpp"
#include "metrics/correction/graph_cost.hpp"

namespace loopbench::metrics {

struct ClosurePredictionOptions {
  std::int64_t max_places = 20;
};

template <class Visit>
void fields(ClosurePredictionOptions& o, Visit visit) {
  visit("max_places",
        o.max_places,
        "maximum number of places, chosen evenly; the method runs once for each [-]",
        Between{2});
}

/// Distance of a closure's measurement from the poses [m], as in ClosureError.
inline double closure_distance(const Edge& closure, const Trajectory& poses) {
  return log_se3(edge_difference(closure, poses)).head<3>().norm();
}

/// Throws Undefined if the keyframes are not the poses of the odometry. O(edges).
inline void require_open_chain(const Problem& problem) {
  double length = 0.0, difference = 0.0;
  for (const Edge& edge : problem.odometry) {
    length += edge.from_from_to.translation.norm();
    difference += closure_distance(edge, problem.keyframes);
  }
  constexpr double kRounding = 1e-3;  // of the path, by the digits of a file
  if (difference <= kRounding * length) return;
  throw Undefined("the keyframes are not the poses of the odometry");
}

/// `ratio` [1]: the method runs without the closures of one place (closure_places.hpp); their error
/// in its result, over that in the keyframes before the correction; geometric mean over places.
/// Below 1, closures at other places predict a place better than the odometry does; 1 for `raw`. It
/// orders methods on one sequence; its size is not the gain in ATE. Errors that all closures share
/// are not visible. For `dual` it is ClosureLedger::ratio. Needs no reference. Throws Undefined
/// without a method to run (files), with fewer than two places, if an edge changes the scale, and
/// if the keyframes differ from the odometry (an optimised graph), because they depend on the
/// closures. One run of the method per place.
inline std::vector<Score> closure_prediction(const Evaluation& evaluation,
                                             const ClosurePredictionOptions& options) {
  const Problem& problem = needed(evaluation.context.problem, "loop closures");
  const SolveWithout& solve_without =
      needed(evaluation.context.solve_without, "a method that can run again");
  const std::vector<std::vector<std::size_t>> all = closure_places(problem.closures);
  if (all.size() < 2) {
    throw Undefined("needs closures at two places, found " + std::to_string(all.size()));
  }
  for (const auto* edges : {&problem.odometry, &problem.closures}) require_rigid(*edges);
  require_open_chain(problem);
  const std::size_t count = std::min(all.size(), static_cast<std::size_t>(options.max_places));
  std::vector<std::vector<std::size_t>> places;
  std::vector<double> predicted(problem.closures.size(), 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    places.push_back(all[i * (all.size() - 1) / (count - 1)]);
    const Trajectory poses = solve_without(places.back());
    for (const std::size_t k : places.back()) {
      predicted[k] = closure_distance(problem.closures[k], poses);
    }
  }
  const auto uncorrected = [&](std::size_t k) {
    return closure_distance(problem.closures[k], problem.keyframes);
  };
  const auto corrected = [&](std::size_t k) { return predicted[k]; };
  Score out = single("ratio", "", "1", place_prediction(places, corrected, uncorrected).ratio);
  out.statistics.count = count;
  return {out};
}

}  // namespace loopbench::metrics
