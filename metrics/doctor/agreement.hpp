/// How well simultaneous poses of two trajectories agree, measured on poses that no fit has used.
#pragma once

#include <string>

#include "metrics/doctor/sampling.hpp"

namespace loopbench::metrics {

/// The poses that fits may use: alternate ones of twenty blocks. O(n).
Paired fitted_part(const Paired& poses);

/// Errors of the test poses [-], [m] or [rad]. Displacements and rotations over short distances are
/// compared in body frames, up to a constant rotation of the body and a scale: drift hardly changes
/// them, and no world frame does.
struct Agreement {
  double position = 0.0;       ///< rmse after a rigid alignment [m]
  double spread = 0.0;         ///< standard deviation of the reference's positions [m]
  bool has_rotations = false;  ///< false: the rotation of one list is constant
  bool is_line = false;        ///< positions on a line, whose alignment leaves a rotation open
  // 1: not compared.
  double rotation = 1.0;       ///< median angle after the alignment of positions [rad]
  double displacement = 1.0;   ///< median error of displacements, over their median length [-]
  double turning = 1.0;        ///< rms error of relative rotations, over their rms [-]
  double usual_turning = 1.0;  ///< median error of relative rotations [rad]

  /// Sum of logarithms of all relative errors; smaller is better.
  double cost() const;

  /// Whether nothing is wrong but drift.
  bool is_good() const;
};

/// Alignments and constant rotations are fitted to one half. Nothing is compared below 20 poses.
/// O(n).
Agreement agreement(const Paired& poses);

inline constexpr double kMostRatio = 0.9;  ///< of an error after a repair over the one before

/// The measure that a change improves most.
struct Improvement {
  std::string text;    ///< "rotation error 90.1 -> 2.5 deg"
  double ratio = 1.0;  ///< after over before
};

Improvement improvement(const Agreement& before, const Agreement& after);

/// Constant rotation body_from_reference of the body, from short motions. O(n).
Rotation body_rotation(const Paired& poses);

/// reference_from_estimate of the positions in least squares (Umeyama 1991). O(n).
Eigen::Affine3d similarity(const Paired& poses);

/// Root mean square of the distances of positions after a transform of the estimate's [m]. O(n).
double position_error(const Paired& poses, const Eigen::Affine3d& reference_from_estimate);

inline constexpr double kLeastRotation = 0.05;  ///< smaller ones cannot be checked [rad]

/// Largest rotation angle from the first pose [rad]. O(n).
double largest_rotation_angle(const Trajectory& poses);

}  // namespace loopbench::metrics
