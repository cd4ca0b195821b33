/// Absolute pose error in evo's pose relations.
#pragma once

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

/// Throws OptionError for point_distance_error_ratio, which is defined only for relative errors.
void check_combination(const ApeOptions& options);

/// One score named after the relation, of E = P^-1 Q for each pair of reference pose P and estimate
/// pose Q. `usual` gives the two scores of ate, `rpy` the three Euler angles of R_P R_Q^T: the
/// rotation error in the world frame, whose yaw is about the world's z axis (as rpg). Throws
/// OptionError as check_combination does. O(n).
std::vector<Score> ape(const Evaluation& evaluation, const ApeOptions& options);

/// Error of one evaluated pose, for the export of error files.
struct PoseError {
  double stamp = 0.0;                ///< stamp of the reference pose [s]
  double estimate_stamp = 0.0;       ///< stamp in the estimate's file [s]
  Vector3 metres = Vector3::Zero();  ///< estimate - reference, in the reference's world frame [m]
  /// Rotation vector of R_P R_Q^T in the same frame [rad]; NaN if a file holds only positions.
  Vector3 radians = Vector3::Zero();
};
std::vector<PoseError> pose_errors(const Evaluation& evaluation);

}  // namespace loopbench::metrics
