/// Transformation of all poses of a trajectory.
#pragma once

#include <string>

#include "datasets/core/trajectory.hpp"

namespace loopbench::harness {

/// p -> scale * R * p + t.
struct Similarity {
  Pose pose;
  double scale = 1.0;
};

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

}  // namespace loopbench::harness
