/// Least-squares rotation between the axes of two bodies.
#pragma once

#include "metrics/alignment/hand_eye/turning_stretches.hpp"

namespace loopbench::metrics {

struct TurnFit {
  Rotation body_from_reference = Rotation::Identity();
  double explained = 0.0;  ///< share of the squared differences of rotations and displacements [-]
};

/// Maps the reference's motions to the estimate's in least squares: Kabsch, of rotation vectors,
/// and of displacements if all rotations have one axis. Identity if the angle is below 5 degrees or
/// the rotation does not explain half of the differences. O(pairs).
TurnFit fit_turn(const std::vector<MotionPair>& pairs);

}  // namespace loopbench::metrics
