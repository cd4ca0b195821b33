/// Marginal likelihood (evidence) of the loop gaps under a noise model, and the expected odometry
/// errors given the gaps. No reference is used.
#pragma once

#include <vector>

#include "methods/correctors/looped_chain.hpp"
#include "methods/correctors/motion_drift/model.hpp"

namespace loopbench::methods {

/// The gaps of the loops and the covariance that each term of a model gives them, at one
/// linearisation point.
struct Evidence {
  std::vector<Eigen::Index> rows;       ///< selected rows of the full gap vector (six per closure)
  Eigen::VectorXd gap;                  ///< gaps of these rows [m], [rad]
  std::vector<Eigen::MatrixXd> shares;  ///< one per term: gap covariance for a term value of 1
};

/// Computes the evidence of `closures` (ascending indices). Planar problems use x, y and yaw of
/// each gap only. Only the lower triangle of each share is filled. O(edges terms + closures^2
/// terms).
Evidence evidence_of(const MotionModel& model,
                     const LoopedChain& chain,
                     const Problem& problem,
                     const std::vector<EdgeMotion>& motions,
                     const std::vector<std::size_t>& closures);

/// Returns sum_j value_j share_j. Only the lower triangle is valid.
Eigen::MatrixXd gap_covariance(const MotionModel& model, const Evidence& evidence);

/// Returns log N(gap; 0, gap_covariance), or -inf when gap_covariance is not positive definite.
/// O(gaps^3 + gaps^2 terms).
double log_evidence(const MotionModel& model, const Evidence& evidence);

/// Returns the expected error of each odometry edge given the loops, averaged over `models`, at the
/// chain's current linearisation point. All models must have the same terms. With the gaps c and
/// their covariance C_s = sum_j v_js Q_j under model s,
///
///     e_i = - sum_j  S_ji A_i' mean_s(v_js C_s^-1 c),
///
/// where S_j is the covariance of all edge errors due to term j with value 1. Only one vector per
/// term is averaged, so the edges are visited once. Throws std::runtime_error when a C_s is
/// singular. O(edges terms + models (6 closures)^3).
std::vector<Twist> mean_errors(const std::vector<MotionModel>& models,
                               const LoopedChain& chain,
                               const Problem& problem,
                               const std::vector<EdgeMotion>& motions);

}  // namespace loopbench::methods
