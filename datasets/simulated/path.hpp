/// Deterministic closed-form paths, which return a pose for any time.
///
/// Body axes: x forward, y left, z up.
#pragma once

#include <cstdint>
#include <functional>
#include <numbers>
#include <stdexcept>

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

/// Hand-held loop through a small room, looking outwards. Duration, number of keyframes, length,
/// speeds and bounding box are those of TUM RGB-D fr1_room reported in the paper.
Path room_path();

/// Hand-held loop around a group of desks, looking inwards, like fr3_long_office_household.
Path office_path();

/// Closed loop of one kilometre through town blocks with stops; some streets are driven twice.
Path driving_path();

inline constexpr double kLineSpeed = 0.5;                           // [m/s]
inline constexpr double kSpinRate = 2.0 * std::numbers::pi / 20.0;  // [rad/s], one rotation per lap

/// Rotation Rz(yaw) Ry(pitch) Rx(roll) [rad]; positive pitch is nose down, positive roll left side
/// up.
inline Rotation rotation_from_yaw_pitch_roll(double yaw, double pitch, double roll) {
  return exp_so3(yaw * Vector3::UnitZ()) * exp_so3(pitch * Vector3::UnitY()) *
         exp_so3(roll * Vector3::UnitX());
}

inline Path path_of(SimulatedPath which) {
  switch (which) {
    case SimulatedPath::room:
      return room_path();
    case SimulatedPath::office:
      return office_path();
    case SimulatedPath::driving:
      return driving_path();
    case SimulatedPath::line:
      return {60.0, 121, 10.0, 0.3, [](double t) {
                return Pose{Rotation::Identity(), Vector3(kLineSpeed * t, 0.0, 0.0)};
              }};
    case SimulatedPath::still:
      return {30.0, 61, 10.0, 0.3, [](double) { return Pose{}; }};
    case SimulatedPath::spin:
      return {20.0, 81, 10.0, 0.3, [](double t) {
                return Pose{rotation_from_yaw_pitch_roll(kSpinRate * t, 0.0, 0.0), Vector3::Zero()};
              }};
  }
  throw std::logic_error("unknown simulated path");
}

}  // namespace loopbench
