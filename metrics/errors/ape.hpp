/// Absolute pose error in evo's pose relations.
#pragma once

#include <string>

#include "datasets/core/parallel.hpp"
#include "metrics/errors/ate.hpp"
#include "metrics/errors/printed_motion.hpp"
#include "metrics/errors/relation.hpp"
#include "metrics/metric.hpp"

namespace loopbench::metrics {

struct ApeOptions {
  Relation relation = Relation::translation_part;
};

template <class Visit>
void fields(ApeOptions& o, Visit visit) {
  visit("relation", o.relation, "pose relation; usual: translation and rotation as in ate");
}

/// Error of one evaluated pose, for the export of error files.
struct PoseError {
  double stamp = 0.0;                ///< stamp of the reference pose [s]
  double estimate_stamp = 0.0;       ///< stamp in the estimate's file [s]
  Vector3 metres = Vector3::Zero();  ///< estimate - reference, in the reference's world frame [m]
  /// Rotation vector of R_P R_Q^T in the same frame [rad]; NaN if a file holds only positions.
  Vector3 radians = Vector3::Zero();
};

/// Throws OptionError for point_distance_error_ratio, which is defined only for relative errors.
inline void check_combination(const ApeOptions& options) {
  if (options.relation != Relation::point_distance_error_ratio) return;
  throw OptionError("relation",
                    "relation = point_distance_error_ratio: is defined only for relative errors; "
                    "use rpe");
}

/// One score named after the relation, of E = P^-1 Q for each pair of reference pose P and estimate
/// pose Q. `usual` gives the two scores of ate, `rpy` the three Euler angles of R_P R_Q^T: the
/// rotation error in the world frame, whose yaw is about the world's z axis (as rpg). Throws
/// OptionError as check_combination does. O(n).
inline std::vector<Score> ape(const Evaluation& evaluation, const ApeOptions& options) {
  check_combination(options);
  const Relation relation = options.relation;
  if (relation == Relation::usual) return ate(evaluation, {});
  const bool is_distance =
      relation == Relation::point_distance || relation == Relation::translation_part;
  if (const std::string why = why_no_attitude(evaluation); !is_distance && !why.empty()) {
    throw Undefined(why);
  }
  const Trajectory& reference = evaluation.reference;
  const Trajectory& estimate = evaluation.estimate;
  const std::size_t n = reference.size();
  Rpy rotation_errors(relation == Relation::rpy ? n : 0);
  std::vector<double> errors(relation == Relation::rpy ? 0 : n);
  const AngleFormula angle = evaluation.protocol.angle;
  const std::optional<PrintedPoses> printed = printed_for_evo(evaluation);
  const auto set = [&](std::size_t i) {
    const Pose& Q = reference[i].world_from_body;
    const Pose& P = estimate[i].world_from_body;
    if (relation == Relation::rpy) {
      rotation_errors.set(i, P.rotation * Q.rotation.conjugate());
    } else if (is_distance) {
      errors[i] = (P.translation - Q.translation).norm();
    } else if (printed) {
      errors[i] = measure(
          relation, printed_relative_pose(printed->estimate[i], printed->reference[i]), angle);
    } else {
      errors[i] = measure(relation, relative_pose(P, Q), angle);
    }
  };
  parallel_for_blocks(n, [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) set(i);
  });
  const int ddof = evaluation.protocol.ddof;
  if (relation == Relation::rpy) return rotation_errors.scores(ddof);
  return {{to_text(relation), "3d", unit(relation), statistics(std::move(errors), ddof)}};
}

inline std::vector<PoseError> pose_errors(const Evaluation& evaluation) {
  std::vector<PoseError> out;
  out.reserve(evaluation.reference.size());
  const bool has_attitude = why_no_attitude(evaluation).empty();
  const Vector3 none = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < evaluation.reference.size(); ++i) {
    const auto& [stamp, Q] = evaluation.reference[i];
    const auto& [estimate_stamp, P] = evaluation.estimate[i];
    out.push_back({stamp,
                   estimate_stamp,
                   P.translation - Q.translation,
                   has_attitude ? log_so3(P.rotation * Q.rotation.conjugate()) : none});
  }
  return out;
}

}  // namespace loopbench::metrics
