/// Gaps of a chain's loops as measurements of drift rates.
#pragma once

#include <optional>

#include "methods/correctors/motion_drift/shared_drift.hpp"

namespace loopbench::methods {

/// Likelihood of the rates b, given the loops of one chain: exp(-misfit + b' vector -
/// b' information b / 2) up to a constant.
struct MeasuredRates {
  DriftRates vector;
  Eigen::Matrix4d information;
  double misfit = 0.0;
};

/// Linearised at the chain without the rates `at`: gap = shapes b + noise.
class ChainGaps {
 public:
  ChainGaps(const Problem& problem, const DriftRates& at);

  /// Under factors on the variances of the odometry; empty: not positive definite. O(gaps^3).
  std::optional<MeasuredRates> measured(const VarianceFactors& factors) const;

  /// -log likelihood of the gaps up to a constant if the rates have this mean and variance;
  /// infinity: not positive definite. O(gaps^3).
  double misfit(const VarianceFactors& factors,
                const DriftRates& mean,
                const DriftRates& variance) const;

 private:
  std::optional<MeasuredRates> measured(const VarianceFactors& factors,
                                        const Eigen::VectorXd& gap,
                                        const Eigen::MatrixXd& added) const;

  LoopCovariance loops_;
  Eigen::VectorXd gap_;
  Eigen::MatrixXd shapes_;
};

}  // namespace loopbench::methods
