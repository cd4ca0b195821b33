/// Nonlinear least-squares solver of a pose graph.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "datasets/core/anchor.hpp"
#include "methods/solvers/elimination_structure.hpp"
#include "methods/solvers/groups/scaled_pose.hpp"

namespace loopbench::methods {

/// Lie group of the poses; level: position and yaw, with a vertical z axis.
enum class Group { se2, se3, sim3, level };

/// Loss rho(x) of a closure, where x is its squared Mahalanobis error; odometry always has x.
enum class RobustLoss {
  none,    ///< x
  huber,   ///< x up to width, then 2 sqrt(width x) - width
  cauchy,  ///< width log(1 + x / width)
  dcs,     ///< x up to width, then 3 width - 4 width^2 / (width + x) (Agarwal 2013: weight s^2)
};
inline auto choices(RobustLoss) {
  return std::array{std::pair{"none", RobustLoss::none},
                    std::pair{"huber", RobustLoss::huber},
                    std::pair{"cauchy", RobustLoss::cauchy},
                    std::pair{"dcs", RobustLoss::dcs}};
}

struct PoseGraphSettings {
  Group group = Group::se3;
  double scale_sigma = 0.01;  ///< deviation of the log scale of an edge, Sim(3) only [-]
  RobustLoss loss = RobustLoss::none;
  double loss_width = 1.0;  ///< width of the loss as a squared error [-]
  int max_iterations = 1000;
  double tolerance = 1e-14;  ///< relative change of the cost at convergence [-]
  /// dcs is replaced by width x / (width + x): switchable constraints, switch eliminated.
  bool is_smoothed = false;
  /// Not in Sim(3), in SE(2) in the plane of pose 0; the loss does not apply to them.
  std::vector<Anchor> anchors = {};
  bool is_first_free = false;  ///< pose 0 is estimated: anchors must determine the frame
};

struct PoseGraphSummary {
  int iterations = 0;        ///< linear solves
  double cost_before = 0.0;  ///< half the sum of losses
  double cost = 0.0;
  bool converged = false;  ///< reached the tolerance before max_iterations
};

struct WeightedEdges {
  const std::vector<Edge>& odometry;
  const std::vector<Edge>& closures;
  const std::vector<double>& weights;  ///< of the closures; 0 removes one

  /// Calls `visit` with each edge that is not removed, its weight and whether it is a closure.
  template <class Visit>
  void for_each(Visit visit) const {
    for (const Edge& edge : odometry) visit(edge, 1.0, false);
    for (std::size_t k = 0; k < closures.size(); ++k) {
      if (weights[k] > 0.0) visit(closures[k], weights[k], true);
    }
  }
};

/// Minimises 1/2 sum w rho(e' Omega e) over `poses`, with e = Log(Z^-1 X_i^-1 X_j) in the twists of
/// the group, plus 1/2 a' C^-1 a of each anchor with a = anchor_error() and covariance C. Pose 0 is
/// fixed unless `is_first_free`. Levenberg-Marquardt
/// with a small initial damping, analytic Jacobians, one thread; results are bit-identical between
/// runs. Without a loss the block structure is that of `cache`, factorised by BlockCholesky; with a
/// loss the solver is Ceres. SE(2) uses the plane of pose 0 and ignores out-of-plane components;
/// `level` likewise ignores roll and pitch; only Sim(3) uses scales. Each iteration is one sparse
/// factorisation, linear in the number of poses for chains with few closures. Throws
/// std::runtime_error when there is no usable solution, and when an information matrix is not
/// positive definite.
PoseGraphSummary solve_pose_graph(std::vector<ScaledPose>& poses,
                                  const WeightedEdges& edges,
                                  const PoseGraphSettings& settings,
                                  EliminationCache& cache);

/// Returns e' Omega e of each edge in the twists of the group, without weight or loss. O(edges).
std::vector<double> squared_errors(const std::vector<ScaledPose>& poses,
                                   const std::vector<Edge>& edges,
                                   const PoseGraphSettings& settings);

/// Derivative of the loss of a closure with respect to its squared error [-].
double loss_derivative(const PoseGraphSettings& settings, double squared);

}  // namespace loopbench::methods
