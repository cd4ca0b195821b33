/// Expected odometry errors, averaged over many noise models.
#pragma once

#include <vector>

#include "methods/correctors/motion_drift/evidence.hpp"

namespace loopbench::methods {

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
