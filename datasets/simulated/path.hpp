/// Closed-form paths: a pose for any time, no state, nothing random.
///
/// The body looks along x, y is to its left, z up.
#pragma once

#include <cstdint>
#include <functional>

#include "datasets/core/pose.hpp"
#include "datasets/simulated/options.hpp"

namespace loopbench {

struct Path {
  double duration;         ///< of one lap [s]
  std::int64_t keyframes;  ///< of one lap
  double frame_rate;       ///< [Hz]
  double closure_radius;   ///< how near a revisit is [m]
  /// world_from_body at any time >= 0 [s]; laps follow each other without a jump. O(1).
  std::function<Pose(double)> at;
};

/// Turned by yaw, then pitch (nose down), then roll (left side up) [rad].
Rotation heading(double yaw, double pitch, double roll);

/// Hand-held once around a small room looking outwards. Duration, keyframes, length, speeds and
/// box of TUM RGB-D fr1_room as the paper reports them.
Path room_path();

/// Hand-held once around a group of desks looking inwards: fr3_long_office_household.
Path office_path();

/// A kilometre through town blocks with stops; some streets are driven twice, both lap ends meet.
Path driving_path();

Path path_of(SimulatedPath which);

}  // namespace loopbench
