/// How one body's axes are turned in another's.
#pragma once

#include "metrics/alignment/hand_eye/turning_stretches.hpp"

namespace loopbench {

struct TurnFit {
  Rotation body_from_reference = Rotation::Identity();
  double explained = 0.0;  ///< part of the squared differences of turns and displacements [-]
};

/// Turns the reference's motions into the estimate's in least squares: Kabsch, of rotation vectors,
/// and of displacements where all turn about one axis. Identity below 5 degrees or where it does
/// not explain half of how they differ. O(pairs).
TurnFit fit_turn(const std::vector<MotionPair>& pairs);

}  // namespace loopbench
