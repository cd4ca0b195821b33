#include "datasets/derive/odometry.hpp"

namespace loopbench {

Matrix6 isotropic_information(double variance_t, double variance_r) {
  Matrix6 out = Matrix6::Zero();
  out.diagonal().head<3>().setConstant(1.0 / variance_t);
  out.diagonal().tail<3>().setConstant(1.0 / variance_r);
  return out;
}

std::vector<Edge> odometry_edges(const Trajectory& keyframes, const EdgeNoise& noise) {
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
