/// Solves bounded losses with a shrinking width, because the closures they reject depend on the
/// initial values.
#pragma once

#include <functional>
#include <vector>

#include "methods/solvers/pose_graph_solver.hpp"

namespace loopbench::methods {

/// Whether the loss is bounded, so that closures with large errors have no influence.
bool is_bounded(RobustLoss loss);

/// Derivative of the bounded loss in `settings` with respect to the squared error, per closure [-].
std::vector<double> loss_weights(const PoseGraphSettings& settings, std::vector<double> squared);

/// Chooses between two initial values and sets `poses` to the one from which the loss in `settings`
/// reaches the lower cost: the given poses, or the solution of a continuation that uses the
/// switchable loss and shrinks its width from the largest squared error by a factor of 0.7 per
/// solve. `solve` minimises from `poses` under the given settings. Returns the cost at the given
/// poses.
double anneal(const std::vector<Edge>& closures,
              const PoseGraphSettings& settings,
              std::vector<ScaledPose>& poses,
              const std::function<PoseGraphSummary(const PoseGraphSettings&)>& solve);

}  // namespace loopbench::methods
