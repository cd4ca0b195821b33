/// Least-squares rotation between the axes of two bodies.
#pragma once

#include "metrics/alignment/hand_eye/rotating_intervals.hpp"

namespace loopbench::metrics {

struct RotationFit {
  Rotation body_from_reference = Rotation::Identity();
  double explained = 0.0;  ///< share of the squared differences of rotations and displacements [-]
};

/// Maps the reference's motions to the estimate's in least squares: Kabsch, of rotation vectors,
/// and of displacements if all rotations have one axis. Identity if the angle is below 5 degrees or
/// the rotation does not explain half of the differences. O(pairs).
RotationFit fit_rotation(const std::vector<RelativePosePair>& pairs);

}  // namespace loopbench::metrics
