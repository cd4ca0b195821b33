/// Relative pose, relative error of two motions, and its angle.
#pragma once

#include <algorithm>
#include <cmath>

#include "datasets/core/pose.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench::metrics {

/// a^-1 b. Half the cost of inverse and product, and subtracts the positions first, which is
/// accurate far from the origin. Inlined, because a call costs as much as the arithmetic.
[[gnu::always_inline]] inline Pose relative_pose(const Pose& world_from_a,
                                                 const Pose& world_from_b) {
  const Rotation a_from_world = world_from_a.rotation.conjugate();
  return {a_from_world * world_from_b.rotation,
          a_from_world * (world_from_b.translation - world_from_a.translation)};
}

/// Relative error for reference poses Q and estimate poses P at both ends, in the given ErrorForm.
/// Eigen's products are inlined, too: calls took a tenth of an evaluation.
[[gnu::flatten]] inline Pose motion_error(
    ErrorForm form, const Pose& Q_i, const Pose& Q_j, const Pose& P_i, const Pose& P_j) {
  switch (form) {
    case ErrorForm::kitti:
      return relative_pose(relative_pose(P_i, P_j), relative_pose(Q_i, Q_j));
    case ErrorForm::tum:
      return relative_pose(relative_pose(P_j, P_i), relative_pose(Q_j, Q_i));
    case ErrorForm::left:
      return (P_i * P_j.inverse()) * (Q_i * Q_j.inverse()).inverse();
    case ErrorForm::evo:
      break;
  }
  return relative_pose(relative_pose(Q_i, Q_j), relative_pose(P_i, P_j));
}

/// Rotation angle for a trace [rad], 0..pi.
inline double trace_angle(double trace) {
  return std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0));
}

/// Length of the logarithm of a unit quaternion [rad], 0..pi. asin takes a fifth of the time of
/// atan2 and is as accurate for small sines.
inline double log_angle(const Rotation& rotation) {
  const double sine = rotation.vec().norm();
  if (sine <= 0.5) return 2.0 * std::asin(sine);
  return 2.0 * std::atan2(sine, std::abs(rotation.w()));
}

/// Rotation angle [rad], 0..pi.
inline double rotation_angle(AngleFormula formula, const Rotation& rotation) {
  if (formula == AngleFormula::rotation_vector) return log_angle(rotation);
  return trace_angle(rotation.toRotationMatrix().trace());
}

}  // namespace loopbench::metrics
