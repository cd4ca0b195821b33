/// Trajectories that hold positions and a made-up attitude: then nothing is said about rotation.
#pragma once

#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// All attitudes are the same (to 1e-9 rad) although the path turns. A body that really keeps its
/// attitude on a straight path is left in peace; one that slides round a bend without turning
/// would be mistaken, and none is known. Fewer than ten poses are no evidence. O(n).
bool is_position_only(const Trajectory& trajectory);

}  // namespace loopbench
