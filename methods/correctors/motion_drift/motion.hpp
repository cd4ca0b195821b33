/// How far, how long and how much each odometry edge moved: what its error may grow with.
#pragma once

#include <array>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

struct EdgeMotion {
  double seconds = 0.0;
  double metres = 0.0;   ///< of the measured step
  double radians = 0.0;  ///< of the measured turn
};

inline std::vector<EdgeMotion> motions(const Problem& problem) {
  std::vector<EdgeMotion> out;
  out.reserve(problem.odometry.size());
  for (const Edge& edge : problem.odometry) {
    out.push_back({problem.keyframes[edge.to].stamp - problem.keyframes[edge.from].stamp,
                   edge.from_from_to.translation.norm(),
                   log_so3(edge.from_from_to.rotation).norm()});
  }
  return out;
}

/// What an error grows with.
enum class Growth { edge, time, distance, rotation, speed };
inline constexpr std::array kGrowths{
    Growth::edge, Growth::time, Growth::distance, Growth::rotation, Growth::speed};

/// "edge", "second", "metre", "radian", "speed": what an option `per_...` is named by.
inline const char* name_of(Growth growth) {
  static constexpr const char* kNames[] = {"edge", "second", "metre", "radian", "speed"};
  return kNames[static_cast<std::size_t>(growth)];
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

}  // namespace loopbench
