/// How far, how long and how much each odometry edge moved: what its error may grow with.
#pragma once

#include <array>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

/// What an error grows with.
enum class Growth { edge, time, distance, rotation, speed };
inline constexpr std::array kGrowths{
    Growth::edge, Growth::time, Growth::distance, Growth::rotation, Growth::speed};

/// "edge", "second", "metre", "radian", "speed": what an option `per_...` is named by.
inline const char* name_of(Growth growth) {
  static constexpr const char* kNames[] = {"edge", "second", "metre", "radian", "speed"};
  return kNames[static_cast<std::size_t>(growth)];
}

struct EdgeMotion {
  double seconds = 0.0;
  double metres = 0.0;   ///< of the measured step
  double radians = 0.0;  ///< of the measured rotation
  /// By Growth, the part of the edge over which steady drift is extrapolated: see drift_reach.hpp.
  std::array<double, kGrowths.size()> drift_part{1.0, 1.0, 1.0, 1.0, 1.0};
};

inline std::vector<EdgeMotion> motions(const Problem& problem) {
  std::vector<EdgeMotion> out;
  out.reserve(problem.odometry.size());
  for (const Edge& edge : problem.odometry) {
    EdgeMotion& motion = out.emplace_back();
    motion.seconds = problem.keyframes[edge.to].stamp - problem.keyframes[edge.from].stamp;
    motion.metres = edge.from_from_to.translation.norm();
    motion.radians = log_so3(edge.from_from_to.rotation).norm();
  }
  return out;
}

/// 1, dt, d, |dtheta| and (d / dt)^2 dt.
inline double grown(Growth with, const EdgeMotion& motion) {
  switch (with) {
    case Growth::edge:
      return 1.0;
    case Growth::time:
      return motion.seconds;
    case Growth::distance:
      return motion.metres;
    case Growth::rotation:
      return motion.radians;
    case Growth::speed:
      return motion.metres * motion.metres / motion.seconds;
  }
  return 0.0;
}

/// What the error of steady drift grows with.
inline double drifted(Growth with, const EdgeMotion& motion) {
  return motion.drift_part[static_cast<std::size_t>(with)] * grown(with, motion);
}

}  // namespace loopbench
