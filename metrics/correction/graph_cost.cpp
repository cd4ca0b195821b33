#include "metrics/correction/graph_cost.hpp"

#include <cmath>

#include "metrics/correction/chordal_weights.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

double squared(const Twist& e, const Matrix6& information) { return e.dot(information * e); }

/// Delta's translation and, in 3-D, twice the vector part of its quaternion; its angle in the
/// plane.
Twist quaternion_error(const Pose& delta, bool planar) {
  const double sign = delta.rotation.w() < 0.0 ? -1.0 : 1.0;
  const Vector3 rotation_vector =
      planar ? log_so3(delta.rotation) : Vector3(2.0 * sign * delta.rotation.vec());
  return twist(delta.translation, rotation_vector);
}

double chordal_cost(const Pose& delta, const ChordalWeights& weights) {
  const Matrix3 off = delta.rotation.toRotationMatrix() - Matrix3::Identity();
  return weights.kappa * off.squaredNorm() + weights.tau * delta.translation.squaredNorm();
}

double cost_of(const Edge& edge, const Trajectory& poses, bool planar, GraphError error) {
  const Pose delta = edge_difference(edge, poses);
  switch (error) {
    case GraphError::twist:
      return squared(log_se3(delta), edge.information);
    case GraphError::quaternion:
      return squared(quaternion_error(delta, planar), edge.information);
    case GraphError::chordal:
      return chordal_cost(delta, chordal_weights(edge, planar));
  }
  return 0.0;
}

}  // namespace

Pose edge_difference(const Edge& edge, const Trajectory& poses) {
  const Pose from_from_to =
      poses.at(edge.from).world_from_body.inverse() * poses.at(edge.to).world_from_body;
  return normalized(edge.from_from_to.inverse() * from_from_to);
}

void require_rigid(const std::vector<Edge>& edges) {
  for (const Edge& edge : edges) {
    if (edge.scale == 1.0) continue;
    throw Undefined("an edge changes the scale (factor " + to_text(edge.scale) +
                    "), but the keyframes are rigid");
  }
}

std::vector<Score> graph_cost(const Evaluation& evaluation, const GraphCostOptions& options) {
  const Problem& problem = needed(evaluation.context.problem, "edges");
  const Trajectory& poses = needed(evaluation.context.estimate, "keyframes");
  const auto sum = [&](const std::vector<Edge>& edges) {
    require_rigid(edges);
    double out = 0.0;
    for (const Edge& edge : edges) out += cost_of(edge, poses, problem.planar, options.error);
    return out;
  };
  const double odometry = sum(problem.odometry);
  const double closures = sum(problem.closures);
  const double anchors = anchor_chi2(problem.anchors, poses);
  // Directed only for the sum, which solvers minimise; its parts are traded off.
  std::vector<Score> out{single("chi2", "all", "1", odometry + closures + anchors),
                         directed(single("chi2", "odometry", "1", odometry), Better::neither),
                         directed(single("chi2", "closures", "1", closures), Better::neither)};
  if (!problem.anchors.empty()) {
    out.push_back(directed(single("chi2", "anchors", "1", anchors), Better::neither));
  }
  return out;
}

std::vector<Score> closure_residual(const Evaluation& evaluation) {
  const Problem& problem = needed(evaluation.context.problem, "loop closures");
  const Trajectory& poses = needed(evaluation.context.estimate, "keyframes");
  if (problem.closures.empty()) {
    throw Undefined("needs loop closures; the sequence has none");
  }
  require_rigid(problem.closures);
  std::vector<double> metres, degrees, mahalanobis;
  for (const Edge& edge : problem.closures) {
    const Pose E = edge_difference(edge, poses);
    const Twist e = log_se3(E);
    metres.push_back(E.translation.norm());
    degrees.push_back(kDegrees * log_so3(E.rotation).norm());
    mahalanobis.push_back(std::sqrt(e.dot(edge.information * e)));
  }
  const int ddof = evaluation.protocol.ddof;
  // Not directed: closures taken as exact have zero residual, even false ones.
  return descriptions({{"translation", "3d", "m", statistics(std::move(metres), ddof)},
                       {"rotation", "3d", "deg", statistics(std::move(degrees), ddof)},
                       {"mahalanobis", "3d", "1", statistics(std::move(mahalanobis), ddof)}});
}

}  // namespace loopbench::metrics
