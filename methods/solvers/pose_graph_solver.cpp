#include "methods/solvers/pose_graph_solver.hpp"

#include "methods/solvers/ceres_minimiser.hpp"
#include "methods/solvers/groups/se2.hpp"
#include "methods/solvers/groups/se3.hpp"
#include "methods/solvers/groups/sim3.hpp"
#include "methods/solvers/levenberg_marquardt.hpp"

namespace loopbench::methods {
namespace {

/// The anchor in the world of pose 0.
Anchor relative_to(const Pose& world_from_first, Anchor anchor) {
  const Matrix3 R = world_from_first.rotation.toRotationMatrix();
  anchor.position = world_from_first.inverse() * anchor.position;
  anchor.covariance = R.transpose() * anchor.covariance * R;
  return anchor;
}

/// Poses are expressed relative to pose 0: a large distance from the world origin costs no
/// precision, and the motion plane need not be horizontal in the world.
template <class G>
PoseGraphSummary solve_in(std::vector<ScaledPose>& poses,
                          WeightedGraph graph,
                          const PoseGraphSettings& settings) {
  const ScaledPose world_from_first = poses.front();
  const ScaledPose first_from_world = world_from_first.inverse();
  std::vector<typename G::Element> x;
  x.reserve(poses.size());
  for (const ScaledPose& pose : poses) x.push_back(G::from(first_from_world * pose));
  for (const Anchor& anchor : settings.anchors) {
    graph.anchors.push_back(relative_to(world_from_first.pose, anchor));
  }
  // Ceres has the corrections of the curvature that robust losses need.
  const PoseGraphSummary summary = settings.loss == RobustLoss::none
                                       ? minimise_least_squares<G>(x, graph, settings)
                                       : minimise_with_ceres<G>(x, graph, settings);
  for (std::size_t i = settings.is_first_free ? 0 : 1; i < poses.size(); ++i) {
    poses[i] = normalized(world_from_first * G::to_scaled_pose(x[i]));
  }
  return summary;
}

template <class G>
std::vector<double> squared_in(const std::vector<ScaledPose>& poses,
                               const std::vector<Edge>& edges,
                               double scale_sigma) {
  std::vector<double> out;
  out.reserve(edges.size());
  const ScaledPose first_from_world = poses.front().inverse();
  const auto relative_pose = [&](std::size_t i) { return G::from(first_from_world * poses[i]); };
  for (const Edge& edge : edges) {
    const auto back = G::inverse(G::from(measured(edge)));
    const auto from_from_to =
        G::compose(G::inverse(relative_pose(edge.from)), relative_pose(edge.to));
    const typename G::Tangent e = group_edge_error<G>(back, from_from_to);
    out.push_back(e.dot(G::information(edge, scale_sigma) * e));
  }
  return out;
}

}  // namespace

PoseGraphSummary solve_pose_graph(std::vector<ScaledPose>& poses,
                                  const std::vector<Edge>& odometry,
                                  const std::vector<Edge>& closures,
                                  const std::vector<double>& weights,
                                  const PoseGraphSettings& settings) {
  if (poses.empty()) return {};
  const WeightedGraph graph{
      poses.size(), odometry, closures, weights, {}, settings.is_first_free, settings.scale_sigma};
  switch (settings.group) {
    case Group::se2:
      return solve_in<Se2>(poses, graph, settings);
    case Group::se3:
      return solve_in<Se3>(poses, graph, settings);
    case Group::sim3:
      return solve_in<Sim3>(poses, graph, settings);
  }
  return {};
}

std::vector<double> squared_errors(const std::vector<ScaledPose>& poses,
                                   const std::vector<Edge>& edges,
                                   const PoseGraphSettings& settings) {
  if (edges.empty()) return {};
  switch (settings.group) {
    case Group::se2:
      return squared_in<Se2>(poses, edges, settings.scale_sigma);
    case Group::se3:
      return squared_in<Se3>(poses, edges, settings.scale_sigma);
    case Group::sim3:
      return squared_in<Sim3>(poses, edges, settings.scale_sigma);
  }
  return {};
}

}  // namespace loopbench::methods
