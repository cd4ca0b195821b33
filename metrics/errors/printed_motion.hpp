/// Relative poses of matrices with the digits as printed in files, as evo computes them.
#pragma once

#include <optional>

#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::metrics {

/// The matrices of both files, the estimate's after alignment, if the protocol uses evo's
/// association and form and pose i of one file is paired with pose i of the other; otherwise
/// nullopt. O(n).
std::optional<PrintedPoses> printed_for_evo(const Evaluation& evaluation);

/// a^-1 b with the transpose of a's left 3 x 3 block as its inverse, which is only approximate for
/// printed digits: evo's relative_se3 (core/lie_algebra.py, commit 26d0953).
PoseMatrix printed_relative_pose(const PoseMatrix& world_from_a, const PoseMatrix& world_from_b);

/// Pose with the exact translation and the rotation nearest to the left 3 x 3 block.
Pose pose_of(const PoseMatrix& matrix);

}  // namespace loopbench::metrics
