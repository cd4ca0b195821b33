/// Covariance of a chain's loop gaps under factors on the stated variances of its odometry.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "methods/correctors/looped_chain.hpp"

namespace loopbench::methods {

/// Factors on the stated variances of all odometry edges [-].
struct VarianceFactors {
  double translation = 1.0;
  double rotation = 1.0;
};

/// Gaps of all closures at the current poses of a chain, and what their covariance consists of.
struct LoopCovariance {
  std::vector<Eigen::Index> rows;  ///< of the full vector: six per closure, or three if planar
  Eigen::VectorXd gap;
  Eigen::MatrixXd translation, rotation, mixed, closures;

  Eigen::MatrixXd under(const VarianceFactors& factors) const;  ///< lower triangle is valid
};

/// O(edges + closures^2).
LoopCovariance loop_covariance(const Problem& problem,
                               const NoiseModel& stated,
                               const LoopedChain& chain);

}  // namespace loopbench::methods
