/// What the loops themselves say about the error model, without any reference.
#pragma once

#include <vector>

#include "methods/correctors/looped_chain.hpp"
#include "methods/correctors/motion_drift/model.hpp"
#include "methods/correctors/motion_drift/variances.hpp"

namespace loopbench {

/// The gaps of the loops and what each term of a model would make of them, at one linearisation.
struct Evidence {
  Eigen::VectorXd gap;
  std::vector<Eigen::MatrixXd> shares;  ///< one a term: covariance of the gap at value 1
};

/// Of `closures`, ascending; a planar problem's gaps have x, y and yaw only. O(edges terms).
Evidence evidence_of(const MotionModel& model,
                     const LoopedChain& chain,
                     const Problem& problem,
                     const std::vector<EdgeMotion>& motions,
                     const std::vector<std::size_t>& closures);

}  // namespace loopbench
