/// Helpers of the metric tests: synthetic trajectories, search for a score.
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "datasets/core/se3.hpp"
#include "datasets/core/trajectory.hpp"
#include "metrics/metric.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::test {

using namespace metrics;

inline Vector3 random_vector(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  const double x = uniform(random);
  const double y = uniform(random);
  return {x, y, uniform(random)};
}

inline Pose random_pose(std::mt19937_64& random, double metres, double radians) {
  return {exp_so3(random_vector(random, radians)), random_vector(random, metres)};
}

/// A random walk of `size` poses, 0.1 s apart.
inline Trajectory random_walk(std::mt19937_64& random, std::size_t size) {
  Trajectory out;
  Pose pose = random_pose(random, 5.0, 1.0);
  for (std::size_t i = 0; i < size; ++i) {
    out.push_back({0.1 * static_cast<double>(i), pose});
    pose = normalized(pose * random_pose(random, 0.3, 0.2));
  }
  return out;
}

/// Every pose with independent noise.
inline Trajectory noisy(std::mt19937_64& random, Trajectory poses, double metres, double radians) {
  for (auto& [stamp, pose] : poses) pose = normalized(pose * random_pose(random, metres, radians));
  return poses;
}

inline Trajectory moved_by(const Pose& there_from_here, double scale, Trajectory poses) {
  for (auto& [stamp, pose] : poses) {
    pose.translation *= scale;
    pose = normalized(there_from_here * pose);
  }
  return poses;
}

inline Statistics find(const std::vector<Score>& scores,
                       const std::string& relation,
                       const std::string& axis) {
  for (const Score& score : scores) {
    if (score.relation == relation && score.axis == axis) return score.statistics;
  }
  throw std::runtime_error("no score " + relation + " " + axis);
}

/// The statistics of the score called "relation axis unit".
inline Statistics named(const std::vector<Score>& scores, const std::string& name) {
  for (const Score& score : scores) {
    if (score.relation + " " + score.axis + " " + score.unit == name) return score.statistics;
  }
  throw std::runtime_error("no score " + name);
}

/// The message of the exception that `action` must throw.
template <class Error, class Action>
std::string why(Action action) {
  return required_refusal_of<Error>(action);
}

}  // namespace loopbench::test
