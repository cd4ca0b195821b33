/// Deterministic closed-form paths, which return a pose for any time.
///
/// Body axes: x forward, y left, z up.
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
  double closure_radius;   ///< maximum distance between the two poses of a revisit [m]
  /// Returns world_from_body at any time >= 0 [s]; continuous between laps. O(1).
  std::function<Pose(double)> at;
};

/// Rotation Rz(yaw) Ry(pitch) Rx(roll) [rad]; positive pitch is nose down, positive roll left side
/// up.
Rotation rotation_from_yaw_pitch_roll(double yaw, double pitch, double roll);

/// Hand-held loop through a small room, looking outwards. Duration, number of keyframes, length,
/// speeds and bounding box are those of TUM RGB-D fr1_room reported in the paper.
Path room_path();

/// Hand-held loop around a group of desks, looking inwards, like fr3_long_office_household.
Path office_path();

/// Closed loop of one kilometre through town blocks with stops; some streets are driven twice.
Path driving_path();

Path path_of(SimulatedPath which);

}  // namespace loopbench
