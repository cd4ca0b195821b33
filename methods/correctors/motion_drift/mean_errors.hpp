/// The errors of the odometry that many error models expect together.
#pragma once

#include <vector>

#include "methods/correctors/motion_drift/evidence.hpp"

namespace loopbench {

/// The mean over `models`, alike in their terms, of what each expects of the edges' errors given
/// the loops, at the chain's current linearisation. With c the gaps and C_s = sum_j v_js Q_j their
/// covariance under model s,
///
///     e_i = - sum_j  S_ji A_i' mean_s(v_js C_s^-1 c),
///
/// S_j being the covariance that term j at value 1 gives all edges' errors: only one vector a term
/// is averaged, and the edges are passed once. Throws std::runtime_error when a C_s is singular.
/// O(edges terms + models (6 closures)^3).
std::vector<Twist> mean_errors(const std::vector<MotionModel>& models,
                               const LoopedChain& chain,
                               const Problem& problem,
                               const std::vector<EdgeMotion>& motions);

}  // namespace loopbench
