/// Record of a replay: the answers of a method while the data of a problem arrived.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// Classes of the age of past poses: their lower limits [s]. The last class is open.
inline constexpr std::array<double, 8> kAges{0.0, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0};

/// Change of the poses of one class by one update.
struct Movement {
  std::size_t poses = 0;
  double translation = 0.0;  ///< root mean square [m]
  double rotation = 0.0;     ///< root mean square [rad]
};

/// One call of the method with the data that had arrived.
struct ReplayUpdate {
  double time = 0.0;          ///< of the last arrival, on the axis of the stamps [s]
  std::size_t keyframes = 0;  ///< known at that time; the last of them is the current one
  std::size_t closures = 0;   ///< arrived or withdrawn since the update before; 0: only keyframes
  double seconds = 0.0;       ///< wall time of the method
  Pose before;                ///< world_from_body of the current keyframe before the update
  Pose after;                 ///< the same after the update
  std::array<Movement, kAges.size()> moved;  ///< of the earlier keyframes, by age
};

struct Replay {
  /// Every keyframe at its own time: with the data that had arrived then, and no later ones.
  Trajectory causal;
  std::vector<ReplayUpdate> updates;  ///< in the order of time
};

}  // namespace loopbench
