/// Record of a replay: the answers of a method while the data of a problem arrived.
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// One call of the method with the data that had arrived.
struct ReplayUpdate {
  double time = 0.0;          ///< of the last arrival, on the axis of the stamps [s]
  std::size_t keyframes = 0;  ///< known at that time; the last of them is the current one
  std::size_t closures = 0;   ///< arrived or withdrawn since the update before; 0: only keyframes
  double seconds = 0.0;       ///< wall time of the method
  Pose before;                ///< world_from_body of the current keyframe before the update
  Pose after;                 ///< the same after the update
};

struct Replay {
  /// Every keyframe at its own time: with the data that had arrived then, and no later ones.
  Trajectory causal;
  std::vector<ReplayUpdate> updates;  ///< in the order of time
};

}  // namespace loopbench
