/// Seeded random poses for property tests.
#pragma once

#include <random>
#include <vector>

#include "datasets/core/se3.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

inline Twist random_twist(std::mt19937_64& random, double metres, double radians) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Twist xi;
  for (double& x : xi) x = unit(random);
  xi.head<3>() *= metres;
  xi.tail<3>() *= radians;
  return xi;
}

/// Random walk of `size` poses, `period` [s] apart, with steps drawn within the bounds [m], [rad].
inline Trajectory random_walk(
    std::size_t size, std::uint64_t seed, double metres, double radians, double period = 1.0) {
  std::mt19937_64 random(seed);
  Trajectory out(size);
  for (std::size_t i = 1; i < size; ++i) {
    out[i].stamp = static_cast<double>(i) * period;
    out[i].world_from_body =
        normalized(out[i - 1].world_from_body * exp_se3(random_twist(random, metres, radians)));
  }
  return out;
}

/// One pose per position on the x axis, `period` [s] apart, with identity rotation.
inline Trajectory on_a_line(const std::vector<double>& xs, double period = 1.0) {
  Trajectory out;
  for (std::size_t i = 0; i < xs.size(); ++i) {
    out.push_back({static_cast<double>(i) * period, {Rotation::Identity(), {xs[i], 0.0, 0.0}}});
  }
  return out;
}

/// One pose per second with identity rotation.
inline Trajectory through(const std::vector<Vector3>& points) {
  Trajectory out;
  for (const Vector3& point : points) {
    out.push_back({static_cast<double>(out.size()), {Rotation::Identity(), point}});
  }
  return out;
}

}  // namespace loopbench
