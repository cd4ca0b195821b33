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
inline Matrix6 isotropic_information(double variance_t, double variance_r) {
  Matrix6 out = Matrix6::Zero();
  out.diagonal().head<3>().setConstant(1.0 / variance_t);
  out.diagonal().tail<3>().setConstant(1.0 / variance_r);
  return out;
}

/// Returns one edge per pair of consecutive keyframes, with exactly their relative pose. O(n).
inline std::vector<Edge> odometry_edges(const Trajectory& keyframes, const EdgeNoise& noise) {
  const auto square = [](double x) { return x * x; };
  std::vector<Edge> edges;
  edges.reserve(keyframes.size());
  for (std::size_t i = 0; i + 1 < keyframes.size(); ++i) {
    const Pose step = keyframes[i].world_from_body.inverse() * keyframes[i + 1].world_from_body;
    const double length = step.translation.norm();
    const double angle = log_so3(step.rotation).norm();
    const auto variance = [&](double at_rest, double per_m, double per_rad) {
      return square(at_rest) + square(per_m) * length + square(per_rad) * angle;
    };
    const double variance_t = variance(noise.sigma_t, noise.sigma_t_per_m, noise.sigma_t_per_rad);
    const double variance_r = variance(noise.sigma_r, noise.sigma_r_per_m, noise.sigma_r_per_rad);
    edges.push_back({i, i + 1, normalized(step), isotropic_information(variance_t, variance_r)});
  }
  return edges;
}

}  // namespace loopbench
