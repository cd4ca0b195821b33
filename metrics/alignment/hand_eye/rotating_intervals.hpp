/// Relative poses over which two trajectories rotate by a given angle.
#pragma once

#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench::metrics {

/// Relative poses of reference and estimate over the same interval, each in its own body frame at
/// the start.
struct RelativePosePair {
  Pose reference;
  Pose estimate;
};

/// From each pose to the first later pose at which both trajectories have rotated by `angle` [rad].
/// Intervals longer than `longest` [s] are skipped, because odometry has drifted by then. The lists
/// are paired. O(n).
std::vector<RelativePosePair> rotating_intervals(const Trajectory& reference,
                                                 const Trajectory& estimate,
                                                 double angle,
                                                 double longest);

}  // namespace loopbench::metrics
