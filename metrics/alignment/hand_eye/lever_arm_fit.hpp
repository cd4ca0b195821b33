/// Least-squares lever arm between two bodies with known relative rotation.
#pragma once

#include <vector>

#include "datasets/core/so3.hpp"

namespace loopbench::metrics {

/// One pair of relative poses: difference = rotation_minus_identity c + s translation + k, with
/// difference = R_C t_Q - t_Z, rotation_minus_identity = R_Z - I and translation = R_C t_Q.
struct LeverArmEquation {
  Matrix3 rotation_minus_identity;
  Vector3 translation;
  Vector3 difference;
  double weight = 1.0;
};

struct LeverArmFit {
  Vector3 lever_arm = Vector3::Zero();  ///< c in the reference's scale; 0 if not significant [m]
  Vector3 deviation = Vector3::Zero();  ///< standard deviations [m]; 0: not significant
  double explained = 0.0;  ///< share of the squared residuals explained by c beyond the scale [-]
};

/// Least squares with Huber weights, free scale, and drift of a few per cent per relative pose.
/// Directions closer than three standard deviations to zero are set to zero. Of more than 20 000
/// equations, about so many are used, evenly chosen. See hand_eye(). O(equations).
LeverArmFit fit_lever_arm(std::vector<LeverArmEquation> equations);

}  // namespace loopbench::metrics
