/// Alignment of an estimate to its reference: least squares, first pose, or none.
///
/// Source: S. Umeyama, Least-squares estimation of transformation parameters between two point
/// patterns, PAMI 13(4), 1991.
#pragma once

#include <optional>

#include "datasets/core/trajectory.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench::metrics {

/// p_reference = scale * R * p_estimate + t.
struct Alignment {
  Align type = Align::none;
  Pose reference_from_estimate;
  double scale = 1.0;
  /// Number of independent directions in the point pattern (0..3): 3 in general position, 2 planar
  /// (still unique), 1 a straight line (rotation about it is free), 0 all in one point. Computed
  /// only for se3, sim3 and scale.
  int rank = 3;
  /// First over second singular value of the cross covariance. A large value means that the pattern
  /// is nearly a straight line, so the rotation about it is poorly determined. 1 for origin, none
  /// and in the plane.
  double condition = 1.0;
};

/// Aligns paired poses. Throws std::invalid_argument if the lists differ in size or are empty. For
/// se3, sim3 and scale, throws std::runtime_error if fewer than two directions are independent, or
/// if the pattern is a mirror image without a preferred axis: the least-squares rotation is then
/// not unique. For posyaw, throws std::runtime_error if the yaw is not determined. If `first` > 0,
/// least squares uses only the first `first` pairs. posyaw and posyaw_origin follow
/// rpg_trajectory_evaluation's align_trajectory.py: the best yaw from the cross covariance, or the
/// yaw between the first orientations. O(n), one pass over the poses.
Alignment align(const Trajectory& reference,
                const Trajectory& estimate,
                Align type,
                std::size_t first = 0);

/// Normals of the planes in which both trajectories move, each in its own world.
struct PlaneNormals {
  Vector3 reference;
  Vector3 estimate;
  bool are_certain = false;
};

/// Aligns paired poses of planar motion by se3 or sim3: the normals coincide, and rotation about
/// them, translation and scale are those of least squares. Unlike align(), it never turns the plane
/// over, and a straight line determines it. Nothing if this explains large errors and the normals
/// are not certain: z up and z down have the same axis of the body. Throws like align(). O(n).
std::optional<Alignment> align_in_plane(const Trajectory& reference,
                                        const Trajectory& estimate,
                                        Align type,
                                        const PlaneNormals& normals,
                                        std::size_t first = 0);

/// Applies the alignment: scales the positions, then left-multiplies every pose.
Trajectory moved(const Alignment& alignment, Trajectory estimate);

}  // namespace loopbench::metrics
