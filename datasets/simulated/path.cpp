#include "datasets/simulated/path.hpp"

#include <numbers>
#include <stdexcept>

namespace loopbench {

Rotation rotation_from_yaw_pitch_roll(double yaw, double pitch, double roll) {
  return exp_so3(yaw * Vector3::UnitZ()) * exp_so3(pitch * Vector3::UnitY()) *
         exp_so3(roll * Vector3::UnitX());
}

namespace {

constexpr double kLineSpeed = 0.5;                           // [m/s]
constexpr double kSpinRate = 2.0 * std::numbers::pi / 20.0;  // [rad/s], one rotation per lap

}  // namespace

Path path_of(SimulatedPath which) {
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
