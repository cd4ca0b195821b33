/// One nonlinear least-squares solve of a pose graph: the only place that knows Ceres.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "methods/solvers/groups/scaled_pose.hpp"

namespace loopbench {

/// What poses are free to do.
enum class Group { se2, se3, sim3 };

/// What a closure's squared, information-weighted error x costs; odometry always costs x.
enum class Loss {
  none,        ///< x
  huber,       ///< x up to width, then 2 sqrt(width x) - width
  cauchy,      ///< width log(1 + x / width)
  dcs,         ///< x up to width, then 3 width - 4 width^2 / (width + x) (Agarwal 2013: weight s^2)
  switchable,  ///< width x / (width + x): switchable constraints with the switch solved for
};
inline auto choices(Loss) {
  return std::array{std::pair{"none", Loss::none},
                    std::pair{"huber", Loss::huber},
                    std::pair{"cauchy", Loss::cauchy},
                    std::pair{"dcs", Loss::dcs},
                    std::pair{"switchable", Loss::switchable}};
}

struct PoseGraphSettings {
  Group group = Group::se3;
  double scale_sigma = 0.01;  ///< of the logarithm of an edge's scale, Sim(3) only [-]
  Loss loss = Loss::none;
  double loss_width = 1.0;  ///< squared error where the loss bends [-]
  int max_iterations = 1000;
  double tolerance = 1e-14;  ///< relative change of the cost that ends it [-]
};

struct PoseGraphSummary {
  int iterations = 0;        ///< linear solves
  double cost_before = 0.0;  ///< half the sum of losses
  double cost = 0.0;
  bool converged = false;  ///< to the tolerance, before max_iterations
};

/// Moves `poses` to a minimum of 1/2 sum w rho(e' Omega e) with e = Log(Z^-1 X_i^-1 X_j) in the
/// group's own twists. Pose 0 is held. weights[k] scales closure k; one of 0 leaves it out.
/// Levenberg-Marquardt from nearly undamped steps on, analytic Jacobians, sparse Cholesky, one
/// thread: the same bits every time. SE(2) works in the plane of pose 0 and ignores what stands out
/// of it; all but Sim(3) ignore scales.
/// Each iteration is one sparse factorisation, linear in poses for chains with few closures.
/// Throws std::runtime_error with Ceres's own words when there is no usable solution, or when
/// information is not positive definite.
PoseGraphSummary solve_pose_graph(std::vector<ScaledPose>& poses,
                                  const std::vector<Edge>& odometry,
                                  const std::vector<Edge>& closures,
                                  const std::vector<double>& weights,
                                  const PoseGraphSettings& settings);

/// e' Omega e of each edge, in the group's twists, without weight or loss. O(edges).
std::vector<double> squared_errors(const std::vector<ScaledPose>& poses,
                                   const std::vector<Edge>& edges,
                                   const PoseGraphSettings& settings);

}  // namespace loopbench
