/// Random loopy chains with full information matrices, for tests of maximum-likelihood methods.
#pragma once

#include <random>

#include "datasets/core/problem.hpp"
#include "tests/datasets/random_poses.hpp"

namespace loopbench::test {

inline Matrix6 random_information(std::mt19937_64& random) {
  Matrix6 root;
  for (int i = 0; i < 6; ++i) root.col(i) = random_twist(random, 3.0, 3.0);
  return root * root.transpose() + 10.0 * Matrix6::Identity();
}

/// A walk of n keyframes with noisy odometry, full information matrices, and two nested loops and
/// one that overlaps them.
inline Problem walk(std::uint64_t seed, std::size_t n, double noise) {
  std::mt19937_64 random(seed);
  Trajectory truth(n);
  for (std::size_t i = 0; i < n; ++i) {
    truth[i].stamp = static_cast<double>(i);
    if (i > 0) {
      truth[i].world_from_body =
          truth[i - 1].world_from_body * exp_se3(random_twist(random, 1.0, 0.5));
    }
  }
  const auto edge = [&](std::size_t from, std::size_t to) {
    const Pose exact = truth[from].world_from_body.inverse() * truth[to].world_from_body;
    return Edge{from,
                to,
                normalized(exact * exp_se3(random_twist(random, noise, noise))),
                random_information(random)};
  };
  Problem out;
  out.keyframes = truth;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    out.odometry.push_back(edge(i, i + 1));
    out.keyframes[i + 1].world_from_body =
        out.keyframes[i].world_from_body * out.odometry[i].from_from_to;
  }
  out.closures = {edge(2, n / 2), edge(1, n - 3), edge(n / 3, n - 1)};
  return out;
}

}  // namespace loopbench::test
