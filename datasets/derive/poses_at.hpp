/// Poses of a run at given times, where available.
#pragma once

#include <optional>
#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench {

struct InterpolationLimits {
  double max_gap = 0.2;    ///< maximum time between interpolated poses [s]
  double max_diff = 0.02;  ///< otherwise, maximum time difference to the nearest pose [s]
};

/// Returns one pose per time, interpolated linearly with SLERP between neighbours, or the nearest
/// pose, or nothing if both are too far away. Times may be in any order. O(n + m) for sorted times.
std::vector<std::optional<Pose>> poses_at(const Trajectory& run,
                                          const std::vector<double>& times,
                                          const InterpolationLimits& reach);

/// Returns the index of the nearest pose in time, if it is at most `max_diff` [s] away. O(log n).
std::optional<std::size_t> nearest_pose(const Trajectory& run, double time, double max_diff);

}  // namespace loopbench
