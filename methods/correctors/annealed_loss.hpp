/// Bounded losses solved with a width that shrinks: which closures they reject depends on the
/// start.
#pragma once

#include <functional>
#include <vector>

#include "methods/solvers/pose_graph_solver.hpp"

namespace loopbench {

/// Losses that are bounded, so that closures with large errors no longer act.
bool is_bounded(Loss loss);

/// Moves `poses` to the better of two minima of the loss in `settings`: that reached directly, and
/// that reached through the switchable loss with a width that starts at the largest squared error
/// and is halved, each solved from the solution before. `solve` minimises from `poses` under the
/// settings it is given. Returns the cost before.
double anneal(const std::vector<Edge>& closures,
              const PoseGraphSettings& settings,
              std::vector<ScaledPose>& poses,
              const std::function<PoseGraphSummary(const PoseGraphSettings&)>& solve);

}  // namespace loopbench
