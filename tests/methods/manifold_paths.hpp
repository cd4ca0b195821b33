/// Small test trajectories for the manifold smoother, and the derivatives of its curves.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/smoothers/manifold/curve.hpp"
#include "tests/datasets/random_poses.hpp"

namespace loopbench {

/// One pose per second along x, so steps equal speeds.
inline Trajectory with_speeds(const std::vector<double>& speeds) {
  std::vector<Vector3> points{Vector3::Zero()};
  for (const double v : speeds) points.push_back(points.back() + Vector3(v, 0.0, 0.0));
  return through(points);
}

/// Hand-held motion: random heading, height and rotation, uneven steps and stamps.
inline Trajectory wandering(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Trajectory out;
  double stamp = 100.0;
  double heading = 0.0;
  Vector3 point(0.3, -0.2, 1.5);
  Rotation rotation = exp_so3({0.3, -0.2, 0.9});
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back({stamp, {rotation, point}});
    stamp += 0.3 + 0.1 * unit(random);
    heading += 0.5 * unit(random);
    const double step = 0.1 + 0.05 * unit(random);
    point += Vector3(step * std::cos(heading), step * std::sin(heading), 0.03 * unit(random));
    rotation = rotation * exp_so3(0.2 * Vector3(unit(random), unit(random), unit(random)));
  }
  return out;
}

inline Problem keyframes_only(Trajectory keyframes) { return {.keyframes = std::move(keyframes)}; }

/// `count` evenly spaced times from the first to the last stamp, both included.
inline std::vector<double> times_over(const Trajectory& poses, std::size_t count) {
  std::vector<double> out;
  const double begin = poses.front().stamp;
  const double end = poses.back().stamp;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    out.push_back(begin + (end - begin) * static_cast<double>(i) / static_cast<double>(count - 1));
  }
  out.push_back(end);
  return out;
}

/// Compares the analytic motion of the manifold smoother's curve with differences of its samples.
inline void expect_motion_is_the_derivative(const Curve& curve) {
  const auto& pieces = dynamic_cast<const methods::manifold::ManifoldCurve&>(curve);
  const double h = 1e-5;
  for (std::size_t edge = 0; edge + 1 < pieces.knots().size(); ++edge) {
    const double t = std::lerp(pieces.knots()[edge], pieces.knots()[edge + 1], 0.37);
    const auto motion = pieces.motion(edge, t);
    const Vector3 slope = (curve.at(t + h).translation - curve.at(t - h).translation) / (2 * h);
    EXPECT_NEAR((motion.value - curve.at(t).translation).norm(), 0.0, 1e-12);
    EXPECT_NEAR((motion.first - slope).norm(), 0.0, 1e-5 * (1.0 + motion.second.norm())) << edge;
  }
}

}  // namespace loopbench
