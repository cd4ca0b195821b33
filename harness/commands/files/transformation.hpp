/// Transformations and corrections of all poses of a trajectory.
#pragma once

#include <string>
#include <vector>

#include "datasets/formats/trajectory_file.hpp"

namespace loopbench::harness {

/// p -> scale * R * p + t.
struct Similarity {
  Pose pose;
  double scale = 1.0;
};

/// Comma-separated finite numbers; empty if `text` is anything else.
std::vector<double> comma_separated_numbers(const std::string& text);

/// Parses x,y,z[,qx,qy,qz,qw], or reads a JSON file with x, y, z, qx, qy, qz, qw and optionally
/// scale, as evo does. Throws InputError.
Similarity read_similarity(const std::string& text);

/// p -> (1 / scale) R^-1 (p - t).
Similarity inverse(const Similarity& similarity);

enum class TransformSide { left, right, right_propagated };

/// left: T * pose; right: pose * T; right_propagated: T is applied to each relative pose, so that
/// it accumulates as drift (evo's --propagate_transform). A scale multiplies positions, on the left
/// only. Throws InputError for a scale on the right. O(n).
Trajectory transformed(Trajectory poses, const Similarity& similarity, TransformSide side);

/// Corrections of conventions in which a file differs from what its reader expects.
struct Conventions {
  std::string quaternion_order;  ///< of the file: wxyz | xyzw, if read in the other; empty: as read
  bool conjugate = false;        ///< invert rotations, not positions
  std::string axes;           ///< source axis of x, y, z of the positions, "-y,x,z"; empty: as read
  std::string mirror;         ///< x, y or z: reversed in positions and rotations; empty: as read
  double scale = 1.0;         ///< factor of the positions
  double stamp_scale = 1.0;   ///< factor of the stamps
  bool invert_poses = false;  ///< body_from_world -> world_from_body
  bool chain = false;         ///< rows are motions from one row to the next: compose them

  friend bool operator==(const Conventions&, const Conventions&) = default;
};

/// Applies all corrections in the order of their declaration. Covariances are removed if poses
/// change; exact stamps too, if stamps are scaled. Throws InputError for an invalid order, axis,
/// list of axes or factor. O(n).
TrajectoryFile corrected(TrajectoryFile file, const Conventions& conventions);

}  // namespace loopbench::harness
