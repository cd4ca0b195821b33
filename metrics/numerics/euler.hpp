/// Roll, pitch and yaw of a rotation: R = R_z(yaw) R_y(pitch) R_x(roll), `sxyz` and `rzyx` of C.
/// Gohlke's transformations.py, which evo and rpg use; same singular case.
#pragma once

#include <limits>

#include "datasets/core/so3.hpp"

namespace loopbench::metrics {

struct Euler {
  double roll = 0.0;   ///< about x [rad], -pi..pi
  double pitch = 0.0;  ///< about y [rad], -pi/2..pi/2
  double yaw = 0.0;    ///< about z [rad], -pi..pi; 0 at gimbal lock
};

inline Euler euler(const Rotation& rotation) {
  const Matrix3 R = rotation.toRotationMatrix();
  const double level = std::sqrt(R(0, 0) * R(0, 0) + R(1, 0) * R(1, 0));
  const double pitch = std::atan2(-R(2, 0), level);
  if (level <= 4.0 * std::numeric_limits<double>::epsilon()) {
    return {std::atan2(-R(1, 2), R(1, 1)), pitch, 0.0};
  }
  return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

}  // namespace loopbench::metrics
