/// The relative error of two motions, and its angle.
#pragma once

#include <algorithm>
#include <cmath>

#include "datasets/core/pose.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench {

/// a^-1 b. Half the work of inverse and product, and the difference of far points is taken first.
inline Pose way(const Pose& world_from_a, const Pose& world_from_b) {
  const Rotation a_from_world = world_from_a.rotation.conjugate();
  return {a_from_world * world_from_b.rotation,
          a_from_world * (world_from_b.translation - world_from_a.translation)};
}

/// Reference poses Q and estimate poses P at both ends; forms as written at ErrorForm.
inline Pose motion_error(
    ErrorForm form, const Pose& Q_i, const Pose& Q_j, const Pose& P_i, const Pose& P_j) {
  switch (form) {
    case ErrorForm::kitti:
      return way(way(P_i, P_j), way(Q_i, Q_j));
    case ErrorForm::tum:
      return way(way(P_j, P_i), way(Q_j, Q_i));
    case ErrorForm::left:
      return (P_i * P_j.inverse()) * (Q_i * Q_j.inverse()).inverse();
    case ErrorForm::evo:
      break;
  }
  return way(way(Q_i, Q_j), way(P_i, P_j));
}

/// Of a rotation with this trace [rad], 0..pi.
inline double trace_angle(double trace) {
  return std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0));
}

/// Length of the logarithm of a unit quaternion [rad], 0..pi. The arcsine takes a fifth of atan2's
/// time and is as exact where it is not steep.
inline double log_angle(const Rotation& rotation) {
  const double sine = rotation.vec().norm();
  if (sine <= 0.5) return 2.0 * std::asin(sine);
  return 2.0 * std::atan2(sine, std::abs(rotation.w()));
}

/// [rad], 0..pi.
inline double rotation_angle(AngleFormula formula, const Rotation& rotation) {
  if (formula == AngleFormula::rotation_vector) return log_angle(rotation);
  return trace_angle(rotation.toRotationMatrix().trace());
}

}  // namespace loopbench
