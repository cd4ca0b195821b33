/// Odometry edges for an estimate that comes as poses only.
#pragma once

#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

/// An assumption, not a measurement: trajectory files carry no covariance. Independent noise on
/// every edge, the same in each direction, whose variances grow with the edge's length d [m] and
/// rotation angle a [rad], so that one edge states as much as the shorter edges it replaces:
///   translation: sigma_t^2 + sigma_t_per_m^2 d + sigma_t_per_rad^2 a,
///   rotation:    sigma_r^2 + sigma_r_per_m^2 d + sigma_r_per_rad^2 a.
/// The defaults are round numbers for a good odometer and are not fitted to any sequence: 0.2 m and
/// 0.3 degrees after 100 m, as LiDAR and stereo odometry reach on roads; 0.3 degrees
/// after one radian of rotation; the floor keeps edges at rest positive definite.
struct EdgeNoise {
  double sigma_t = 0.001;          ///< of an edge at rest [m]
  double sigma_r = 0.0001;         ///< of an edge at rest [rad]
  double sigma_t_per_m = 0.02;     ///< after one metre [m]
  double sigma_r_per_m = 0.0005;   ///< after one metre [rad]
  double sigma_t_per_rad = 0.02;   ///< after one radian [m]
  double sigma_r_per_rad = 0.005;  ///< after one radian [rad]
};

/// diag(1/variance_t x 3, 1/variance_r x 3). Variances [m^2], [rad^2].
Matrix6 isotropic_information(double variance_t, double variance_r);

/// One edge per pair of consecutive keyframes: exactly their relative pose. O(n).
std::vector<Edge> odometry_edges(const Trajectory& keyframes, const EdgeNoise& noise);

}  // namespace loopbench
