/// What a pose graph's edges still disagree with: the cost that its optimisation lowers.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

/// With Delta = Z^-1 X_from^-1 X_to for an edge Z of information Omega:
enum class GraphError {
  twist,       ///< e = Log(Delta); e' Omega e. What `pose_graph` and `dual` minimise
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
  visit("error", o.error, "of an edge: its twist, as g2o counts, or as SE-Sync counts");
}

/// Sums over edges, not halved (GTSAM and Ceres print half of it): chi2 of all, of odometry, of
/// closures [1]. For chordal, as SE-Sync reads g2o files: tau = d / tr(S_t), kappa = 3 / (2
/// tr(S_phi)) in space (d = 3) and yaw's whole information in the plane (d = 2). Needs no
/// reference. Throws std::runtime_error when an edge changes the unit of length: rigid keyframes
/// cannot say how well it is met. O(keyframes + edges).
std::vector<Score> graph_cost(const Evaluation& evaluation, const GraphCostOptions& options);

}  // namespace loopbench
