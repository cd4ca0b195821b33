/// Odometry edges for an estimate that consists of poses only.
#pragma once

#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

/// Assumed noise model of odometry edges, because trajectory files contain no covariance. Noise is
/// independent and isotropic. Variances are linear in the length d [m] and the rotation angle a
/// [rad] of an edge, so that one edge has about the information of the shorter edges it replaces:
///   translation: sigma_t^2 + sigma_t_per_m^2 d + sigma_t_per_rad^2 a,
///   rotation:    sigma_r^2 + sigma_r_per_m^2 d + sigma_r_per_rad^2 a.
/// The defaults are round numbers for accurate odometry and are not fitted to any sequence: 0.2 m
/// and 0.3 degrees after 100 m, typical of LiDAR and stereo odometry on roads; 0.3 degrees after 1
/// rad of rotation. The constant terms keep edges at rest positive definite.
struct EdgeNoise {
  double sigma_t = 0.001;          ///< of an edge at rest [m]
  double sigma_r = 0.0001;         ///< of an edge at rest [rad]
  double sigma_t_per_m = 0.02;     ///< after one metre [m]
  double sigma_r_per_m = 0.0005;   ///< after one metre [rad]
  double sigma_t_per_rad = 0.02;   ///< after one radian [m]
  double sigma_r_per_rad = 0.005;  ///< after one radian [rad]
};

/// Information diag(1/variance_t x 3, 1/variance_r x 3) from variances [m^2], [rad^2].
Matrix6 isotropic_information(double variance_t, double variance_r);

/// Returns one edge per pair of consecutive keyframes, with exactly their relative pose. O(n).
std::vector<Edge> odometry_edges(const Trajectory& keyframes, const EdgeNoise& noise);

}  // namespace loopbench
