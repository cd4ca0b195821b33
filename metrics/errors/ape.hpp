/// Absolute pose error in evo's pose relations.
#pragma once

#include "metrics/errors/relation.hpp"
#include "metrics/metric.hpp"

namespace loopbench {

struct ApeOptions {
  Relation relation = Relation::translation_part;
};

template <class Visit>
void fields(ApeOptions& o, Visit visit) {
  visit("relation", o.relation, "what is measured; usual is ate's, rpy in the world");
}

/// Throws OptionError for point_distance_error_ratio, which is of motions only.
void check_combination(const ApeOptions& options);

/// One score named after the relation, of E = P^-1 Q for each pair; `usual` gives ate's two, rpy
/// three of R_P R_Q^T: the turn in the world, so that its yaw is about the world's z (rpg's).
/// Throws OptionError as check_combination does. O(n).
std::vector<Score> ape(const Evaluation& evaluation, const ApeOptions& options);

/// One judged pose, for files of errors.
struct PoseError {
  double stamp = 0.0;                ///< of the reference [s]
  double estimate_stamp = 0.0;       ///< in the estimate's file [s]
  Vector3 metres = Vector3::Zero();  ///< estimate - reference, in the reference's world
  /// Rotation vector of R_P R_Q^T, in that world; NaN where a file holds positions only.
  Vector3 radians = Vector3::Zero();
};
std::vector<PoseError> pose_errors(const Evaluation& evaluation);

}  // namespace loopbench
