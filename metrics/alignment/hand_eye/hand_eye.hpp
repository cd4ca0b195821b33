/// Where one body sits in another, from how both move: hand and eye.
#pragma once

#include "metrics/alignment/hand_eye/turning_stretches.hpp"

namespace loopbench {

/// What reference Q and estimate Z of one body with offset C owe to it: Z C = C Q.
struct HandEye {
  /// C, body_from_reference, in the reference's unit of length. Its translation is zero in
  /// directions that are not told.
  Pose body_from_reference;
  Vector3 deviation = Vector3::Zero();  ///< standard deviations of the translation, 0: not told [m]
  double turn_explained = 0.0;   ///< part of the squared differences that C's rotation explains [-]
  double lever_explained = 0.0;  ///< part of what then is left that its translation explains [-]
};

/// The rotation turns the reference's motions into the estimate's in least squares (Kabsch, of
/// rotation vectors, and of displacements where all turn about one axis); it is left out below 5
/// degrees or where it does not explain half of how they differ. The translation c solves
///
///     (R_Z - I) c + s R_C t_Q + k = R_C t_Q - t_Z
///
/// with Huber's weights, any factor 1 - s of the unit of length (who looks at a thing while going
/// round it would take one for the other) and drift k of a few per cent a stretch (where all turn
/// one way it looks like another place). Directions are told that lie three deviations from zero.
/// What c explains is judged apart from the scale, but of drift, too, and not of jumps.
///
/// Attitude noise per stretch shrinks c, and who turns on the spot tells nothing of it: all that
/// the reference moves could be scale. Needs more pairs than unknowns. O(pairs). Source: F. Park,
/// B. Martin, Robot sensor calibration: solving AX = XB on the Euclidean group, IEEE T-RO 1994.
HandEye hand_eye(const std::vector<MotionPair>& pairs);

}  // namespace loopbench
