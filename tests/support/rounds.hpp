/// Three rounds of a circle with closures at five places.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "datasets/core/problem.hpp"
#include "datasets/core/se3.hpp"

namespace loopbench::test {

inline constexpr double kStepSigma = 0.01;  // of the odometry [m] and [rad]

/// Three rounds of a circle. Odometry has noise and a bias of a fifth of its deviation in yaw,
/// closures between the rounds have noise.
inline Problem rounds(std::uint64_t seed, double sigma = kStepSigma) {
  constexpr std::size_t kRound = 60;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto noise = [&](double size) {
    Twist out;
    for (int i = 0; i < 6; ++i) out[i] = size * normal(random);
    return out;
  };
  const Pose step = exp_se3(twist(Vector3(1.0, 0.0, 0.0), Vector3(0.0, 0.0, 2.0 * M_PI / kRound)));
  Problem out;
  Trajectory truth;
  const Matrix6 information = Matrix6::Identity() / (sigma * sigma);
  for (std::size_t i = 0; i < 3 * kRound; ++i) {
    if (i == 0) {
      truth.push_back({0.0, Pose{}});
      out.keyframes.push_back({0.0, Pose{}});
      continue;
    }
    const auto stamp = static_cast<double>(i);
    truth.push_back({stamp, normalized(truth.back().world_from_body * step)});
    const Pose measured = normalized(step * exp_se3(noise(sigma) + 0.2 * sigma * Twist::Unit(5)));
    out.odometry.push_back({i - 1, i, measured, information});
    out.keyframes.push_back({stamp, normalized(out.keyframes.back().world_from_body * measured)});
  }
  for (const std::size_t from : {2UL, 28UL, 54UL, 80UL, 106UL}) {
    const std::size_t to = from + kRound;
    const Pose loop = truth[from].world_from_body.inverse() * truth[to].world_from_body;
    out.closures.push_back({from, to, normalized(loop * exp_se3(noise(sigma))), information});
  }
  return out;
}

}  // namespace loopbench::test
