/// Stretches of the way over which two lists of poses turn.
#pragma once

#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// How reference and estimate moved over the same time, each in its own body at the beginning.
struct MotionPair {
  Pose reference;
  Pose estimate;
};

/// From each pose on to the first that both have turned to by `turn` [rad]; stretches that take
/// longer than `longest` [s] are left out, for then odometry has drifted. The lists are pairs.
/// O(n).
std::vector<MotionPair> turning_stretches(const Trajectory& reference,
                                          const Trajectory& estimate,
                                          double turn,
                                          double longest);

}  // namespace loopbench
