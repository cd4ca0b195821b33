/// Relative poses of matrices with the digits as printed in files, as evo computes them.
#pragma once

#include <optional>

#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::metrics {

inline bool has_stamps_of(const Trajectory& evaluated, const Trajectory* complete) {
  return complete != nullptr && stamps(evaluated) == stamps(*complete);
}

/// The matrices of both files, the estimate's after alignment, if the protocol uses evo's
/// association and form and pose i of one file is paired with pose i of the other; otherwise
/// nullopt. O(n).
inline std::optional<PrintedPoses> printed_for_evo(const Evaluation& evaluation) {
  const Protocol& p = evaluation.protocol;
  const Context& context = evaluation.context;
  const bool is_evo = p.association == Association::evo && p.form == ErrorForm::evo &&
                      p.project == ProjectionPlane::none && p.offset == 0.0;
  if (!is_evo || context.printed == nullptr) return std::nullopt;
  if (!has_stamps_of(evaluation.reference, context.reference) ||
      !has_stamps_of(evaluation.estimate, context.estimate)) {
    return std::nullopt;
  }
  PrintedPoses out = *context.printed;
  if (evaluation.alignment.type == Align::none) return out;
  const auto& [rotation, translation] = evaluation.alignment.reference_from_estimate;
  const Matrix3 R = rotation.toRotationMatrix();
  for (PoseMatrix& pose : out.estimate) {
    const Vector3 position = evaluation.alignment.scale * (R * pose.translation()) + translation;
    pose.linear() = (R * pose.linear()).eval();
    pose.translation() = position;
  }
  return out;
}

/// a^-1 b with the transpose of a's left 3 x 3 block as its inverse, which is only approximate for
/// printed digits: evo's relative_se3 (core/lie_algebra.py, commit 26d0953).
inline PoseMatrix printed_relative_pose(const PoseMatrix& world_from_a,
                                        const PoseMatrix& world_from_b) {
  const Matrix3 a_from_world = world_from_a.linear().transpose();
  PoseMatrix out;
  out.linear() = a_from_world * world_from_b.linear();
  out.translation() =
      a_from_world * world_from_b.translation() - a_from_world * world_from_a.translation();
  return out;
}

}  // namespace loopbench::metrics
