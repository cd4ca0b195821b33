/// Moving an estimate onto its reference: least squares, first pose, or not at all.
///
/// Source: S. Umeyama, Least-squares estimation of transformation parameters between two point
/// patterns, PAMI 13(4), 1991.
#pragma once

#include "datasets/core/trajectory.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench {

/// p_reference = scale * R * p_estimate + t.
struct Alignment {
  Align type = Align::none;
  Pose reference_from_estimate;
  double scale = 1.0;
  /// Number of independent directions in the point pattern (0..3): 3 in general position, 2 planar
  /// (still unique), 1 a straight line (rotation about it is free), 0 all in one point. Only se3,
  /// sim3 and scale look.
  int rank = 3;
  /// First over second singular value of the cross covariance: large when the pattern is nearly a
  /// straight line and rotation about it hangs on little. 1 for origin and none.
  double condition = 1.0;
};

/// Aligns paired poses (same size, not empty; std::invalid_argument else). For se3, sim3 and scale,
/// throws std::runtime_error when fewer than two directions are independent, or the pattern is a
/// mirror image with no preferred axis: the least-squares rotation is then not unique; for posyaw
/// when nothing turns about z. `first` > 0: least squares see only so many pairs (or all there
/// are). posyaw and posyaw_origin: rpg_trajectory_evaluation's align_trajectory.py, best yaw by the
/// cross covariance or the first attitudes. O(n), reads each pose once from memory.
Alignment align(const Trajectory& reference,
                const Trajectory& estimate,
                Align type,
                std::size_t first = 0);

/// The estimate moved: positions scaled, then everything left-multiplied.
Trajectory moved(const Alignment& alignment, Trajectory estimate);

}  // namespace loopbench
