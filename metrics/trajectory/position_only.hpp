/// Detection of trajectories that hold only positions, without or with a placeholder orientation.
#pragma once

#include "datasets/core/trajectory.hpp"

namespace loopbench::metrics {

/// True if the trajectory lacks_rotations(), or if all orientations are equal (to 1e-9 rad)
/// although the path is curved. A body that really keeps its orientation on a straight path is not
/// affected; one that moves along a curve without rotating would be misclassified. False for fewer
/// than ten poses. O(n).
bool is_position_only(const Trajectory& trajectory);

}  // namespace loopbench::metrics
