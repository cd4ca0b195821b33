/// What the loops themselves say about the error model, without any reference.
#pragma once

#include <vector>

#include "methods/correctors/looped_chain.hpp"
#include "methods/correctors/motion_drift/model.hpp"

namespace loopbench {

/// The gaps of the loops and what each term of a model would make of them, at one linearisation.
struct Evidence {
  std::vector<Eigen::Index> rows;       ///< which of all gaps, six a closure, are looked at
  Eigen::VectorXd gap;                  ///< of these rows
  std::vector<Eigen::MatrixXd> shares;  ///< one a term: its covariance of the gap at value 1
};

/// Of `closures`, ascending; a planar problem's gaps have x, y and yaw only. Of a share the lower
/// triangle is filled. O(edges terms + closures^2 terms).
Evidence evidence_of(const MotionModel& model,
                     const LoopedChain& chain,
                     const Problem& problem,
                     const std::vector<EdgeMotion>& motions,
                     const std::vector<std::size_t>& closures);

/// sum_j value_j share_j; only its lower triangle means anything.
Eigen::MatrixXd gap_covariance(const MotionModel& model, const Evidence& evidence);

/// log N(gap; 0, gap_covariance); -inf when that is no covariance. O(gaps^3 + gaps^2 terms).
double log_evidence(const MotionModel& model, const Evidence& evidence);

}  // namespace loopbench
