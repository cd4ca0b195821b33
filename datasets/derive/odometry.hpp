/// Odometry edges for an estimate that comes as poses only.
#pragma once

#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

/// An assumption, not a measurement: trajectory files carry no covariance. Independent noise on
/// every edge, the same in each direction, with variances
///   translation: sigma_t^2 + sigma_t_per_m^2 d,   rotation: sigma_r^2 + sigma_r_per_m^2 d,
/// d being the edge's length [m].
struct EdgeNoise {
  double sigma_t = 0.01;       ///< per edge [m]
  double sigma_r = 0.005;      ///< per edge [rad]
  double sigma_t_per_m = 0.0;  ///< after one metre [m]
  double sigma_r_per_m = 0.0;  ///< after one metre [rad]
};

/// diag(1/variance_t x 3, 1/variance_r x 3). Variances [m^2], [rad^2].
Matrix6 isotropic_information(double variance_t, double variance_r);

/// One edge per pair of consecutive keyframes: exactly their relative pose. O(n).
std::vector<Edge> odometry_edges(const Trajectory& keyframes, const EdgeNoise& noise);

}  // namespace loopbench
