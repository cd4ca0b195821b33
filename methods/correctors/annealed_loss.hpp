/// Bounded losses solved with a width that shrinks: which closures they reject depends on the
/// start.
#pragma once

#include <functional>
#include <vector>

#include "methods/solvers/pose_graph_solver.hpp"

namespace loopbench {

/// Losses that are bounded, so that closures with large errors no longer act.
bool is_bounded(Loss loss);

/// Derivative of the bounded loss in `settings` by the squared error, of each closure [-].
std::vector<double> loss_weights(const PoseGraphSettings& settings, std::vector<double> squared);

/// Sets `poses` to the start from which the loss in `settings` has the lower of two minima: where
/// they are, or the solution under the switchable loss with a width that starts at the largest
/// squared error and shrinks by 0.7, each solved from the one before. `solve` minimises from
/// `poses` under the settings it is given. Returns the cost before.
double anneal(const std::vector<Edge>& closures,
              const PoseGraphSettings& settings,
              std::vector<ScaledPose>& poses,
              const std::function<PoseGraphSummary(const PoseGraphSettings&)>& solve);

}  // namespace loopbench
