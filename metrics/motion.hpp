/// The relative error of two motions, and its angle.
#pragma once

#include <algorithm>

#include "datasets/core/pose.hpp"
#include "metrics/protocol.hpp"

namespace loopbench {

/// Reference poses Q and estimate poses P at both ends; forms as written at ErrorForm.
inline Pose motion_error(
    ErrorForm form, const Pose& Q_i, const Pose& Q_j, const Pose& P_i, const Pose& P_j) {
  switch (form) {
    case ErrorForm::kitti:
      return (P_i.inverse() * P_j).inverse() * (Q_i.inverse() * Q_j);
    case ErrorForm::tum:
      return (P_j.inverse() * P_i).inverse() * (Q_j.inverse() * Q_i);
    case ErrorForm::left:
      return (P_i * P_j.inverse()) * (Q_i * Q_j.inverse()).inverse();
    case ErrorForm::evo:
      break;
  }
  return (Q_i.inverse() * Q_j).inverse() * (P_i.inverse() * P_j);
}

/// Of a rotation with this trace [rad], 0..pi.
inline double trace_angle(double trace) {
  return std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0));
}

/// [rad], 0..pi.
inline double rotation_angle(AngleFormula formula, const Rotation& rotation) {
  if (formula == AngleFormula::rotation_vector) return log_so3(rotation).norm();
  return trace_angle(rotation.toRotationMatrix().trace());
}

}  // namespace loopbench
