/// Covariances of the poses of a solved pose graph.
#pragma once

#include <vector>

#include "methods/solvers/pose_graph_solver.hpp"

namespace loopbench::methods {

/// Returns the covariance of each pose in fixed axes (datasets/core/covariance.hpp), to first order
/// at `poses`, the minimum of solve_pose_graph() with the same arguments: blocks on the diagonal of
/// the inverse of sum w rho' J' Omega J, with the information of the anchors. It is zero for pose 0
/// unless `is_first_free`. In SE(2), poses have no errors out of the plane: these covariances are
/// zero. In Sim(3), that of the scale is left out. Time and memory of one factorisation. Throws
/// std::runtime_error if the information is not positive definite.
std::vector<Matrix6> graph_covariances(const std::vector<ScaledPose>& poses,
                                       const WeightedEdges& edges,
                                       const PoseGraphSettings& settings);

}  // namespace loopbench::methods
