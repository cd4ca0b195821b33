/// Relative poses of matrices with the digits of their files, as evo computes them.
#pragma once

#include <optional>

#include "metrics/evaluation/evaluation.hpp"

namespace loopbench {

/// The matrices of both files, the estimate's moved by the alignment, when the protocol is evo's
/// (association and form) and pose i of one file was judged against pose i of the other; nothing
/// otherwise. O(n).
std::optional<PrintedPoses> printed_for_evo(const Evaluation& evaluation);

/// a^-1 b with the transpose of a's left 3 x 3 as its inverse, which for printed digits is not
/// quite the inverse: evo's relative_se3 (core/lie_algebra.py, commit 26d0953).
PoseMatrix printed_way(const PoseMatrix& world_from_a, const PoseMatrix& world_from_b);

/// Its translation with all digits, and the rotation nearest to its left 3 x 3.
Pose pose_of(const PoseMatrix& matrix);

}  // namespace loopbench
