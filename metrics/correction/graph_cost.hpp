/// Cost of a pose graph and residuals of its loop closures after the correction.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

/// With Delta = Z^-1 X_from^-1 X_to for an edge Z of information Omega:
enum class GraphError {
  twist,       ///< e = Log(Delta); e' Omega e. The objective of `pose_graph` and `dual`
  quaternion,  ///< e = [t; 2 q_xyz] of Delta, q_w >= 0; in the plane [t; angle]. g2o's chi2
  chordal,     ///< kappa |R_to - R_from Z_R|_F^2 + tau |t_to - t_from - R_from Z_t|^2. SE-Sync's
};
inline auto choices(GraphError) {
  return std::array{std::pair{"twist", GraphError::twist},
                    std::pair{"quaternion", GraphError::quaternion},
                    std::pair{"chordal", GraphError::chordal}};
}

struct GraphCostOptions {
  GraphError error = GraphError::twist;
};

template <class Visit>
void fields(GraphCostOptions& o, Visit visit) {
  visit(
      "error", o.error, "residual of an edge: twist, quaternion (as g2o) or chordal (as SE-Sync)");
}

/// Returns Z^-1 X_from^-1 X_to of an edge Z at poses X.
Pose edge_difference(const Edge& edge, const Trajectory& poses);

/// Throws Undefined if an edge changes the scale: rigid keyframes do not define its residual.
/// O(edges).
void require_rigid(const std::vector<Edge>& edges);

/// Sums over edges, without the factor 1/2 of GTSAM and Ceres: chi2 of all edges and anchors, of
/// odometry, of closures, and of anchors if there are any [1]. For chordal, weights as in
/// chordal_weights.hpp. Needs no reference. Throws Undefined if an edge changes the scale.
/// O(keyframes + edges).
std::vector<Score> graph_cost(const Evaluation& evaluation, const GraphCostOptions& options);

/// E = L^-1 X_from^-1 X_to for every closure L, with X the unaligned estimate at its keyframes:
/// translation 3d [m] |trans(E)|, rotation 3d [deg] angle(E), and mahalanobis 3d [1]
/// sqrt(e^T information e) with e = Log(E); 6 degrees of freedom, so about sqrt(6) rms if the
/// information is consistent. A small residual shows that the closures were fitted, not that they
/// are correct. Throws Undefined without closures, and if a closure changes the scale (Sim(3)
/// chains). O(keyframes + closures).
std::vector<Score> closure_residual(const Evaluation& evaluation);

}  // namespace loopbench::metrics
