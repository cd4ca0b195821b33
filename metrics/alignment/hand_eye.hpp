/// Hand-eye calibration: extrinsic offset between two bodies from their motions.
#pragma once

#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench::metrics {

/// Relative poses of reference and estimate over the same interval, each in its own body frame at
/// the start.
struct RelativePosePair {
  Pose reference;
  Pose estimate;
};

/// From each pose to the first later pose at which both trajectories have rotated by `angle` [rad].
/// Intervals longer than `longest` [s] are skipped, because odometry has drifted by then. The lists
/// are paired. O(n).
std::vector<RelativePosePair> rotating_intervals(const Trajectory& reference,
                                                 const Trajectory& estimate,
                                                 double angle,
                                                 double longest);

/// Solution of the hand-eye equation Z C = C Q for relative poses Q (reference) and Z (estimate).
struct HandEye {
  /// C, body_from_reference, in the reference's scale. Its translation (the lever arm) is zero in
  /// directions that are not significant.
  Pose body_from_reference;
  Vector3 deviation =
      Vector3::Zero();  ///< std of the translation [m]; 0: direction not significant
  double rotation_explained =
      0.0;  ///< share of the squared differences explained by C's rotation [-]
  double lever_arm_explained =
      0.0;  ///< share of the remaining ones explained by its translation [-]
};

/// The rotation maps the reference's motions to the estimate's in least squares (Kabsch, of
/// rotation vectors, and of displacements if all rotations have one axis). It is the identity if it
/// is below 5 degrees or does not explain half of the differences. The lever arm c solves
///
///     (R_Z - I) c + s R_C t_Q + k = R_C t_Q - t_Z
///
/// with Huber weights, for any scale factor 1 - s (a camera that circles an object cannot separate
/// scale from lever arm) and a drift k of a few per cent per relative pose (if all rotations have
/// the same sign, drift resembles a lever arm). A direction is significant if it is three standard
/// deviations from zero. The share explained by c excludes the scale, but not drift or jumps.
///
/// Rotation noise shrinks c. Rotations in place carry no information about c, because all motion
/// of the reference can be explained by scale. Needs more pairs than unknowns. O(pairs). Source:
/// F. Park, B. Martin, Robot sensor calibration: solving AX = XB on the Euclidean group, IEEE T-RO
/// 1994.
HandEye hand_eye(const std::vector<RelativePosePair>& pairs);

}  // namespace loopbench::metrics
