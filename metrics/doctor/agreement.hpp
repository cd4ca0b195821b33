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
  double similarity = 0.0;     ///< rmse after a similarity [m]
  double spread = 0.0;         ///< standard deviation of the reference's positions [m]
  double rotation = 0.0;       ///< median angle after the alignment of positions [rad]
  double displacement = 0.0;   ///< median error of displacements, over their median length [-]
  double scale = 1.0;          ///< of these displacements, reference over estimate [-]
  double turning = 0.0;        ///< rms error of relative rotations, over their rms [-]
  double usual_turning = 0.0;  ///< median error of relative rotations [rad]
  bool has_rotations = true;   ///< false: the rotation of one list is constant
  bool is_line = false;        ///< positions on a line, whose alignment leaves a rotation open

  /// Sum of logarithms of all relative errors; smaller is better.
  double cost() const;
};

/// Alignments and constant rotations are fitted to one half. All errors are 0 below 20 poses. O(n).
Agreement agreement(const Paired& poses);

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

inline constexpr double kLeastRotation = 0.05;  ///< smaller ones cannot be checked [rad]

/// Largest rotation angle from the first pose [rad]. O(n).
double largest_rotation_angle(const Trajectory& poses);

/// Whether both rotate by more than kLeastRotation. O(n).
bool has_rotations(const Paired& poses);

}  // namespace loopbench::metrics
