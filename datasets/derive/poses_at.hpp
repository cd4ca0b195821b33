/// Where a run was at given times, and where it does not know.
#pragma once

#include <optional>
#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench {

struct Reach {
  double max_gap = 0.2;    ///< interpolate only between poses at most this far apart [s]
  double max_diff = 0.02;  ///< else take the nearest pose at most this far away [s]
};

/// One answer per time (ascending or not). Straight line and SLERP between neighbours. Sorted
/// times cost O(n + m).
std::vector<std::optional<Pose>> poses_at(const Trajectory& run,
                                          const std::vector<double>& times,
                                          const Reach& reach);

/// Index of the pose nearest in time, if at most `max_diff` [s] away. O(log n).
std::optional<std::size_t> nearest_pose(const Trajectory& run, double time, double max_diff);

}  // namespace loopbench
