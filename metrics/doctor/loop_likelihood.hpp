/// Likelihood of neighbouring loops together, with fitted sizes of the noise.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "metrics/doctor/closure_chain.hpp"

namespace loopbench::metrics {

/// Errors with which the odometry and the other closures of a group predict each closure.
struct PredictionError {
  std::vector<double> metres;
  std::vector<double> radians;
};

/// A few closures with the odometry that their loops share, which explains a part of their gaps
/// together.
class LoopGroup {
 public:
  LoopGroup(std::vector<const Edge*> closures, const Chain& chain);

  const std::vector<const Edge*>& closures() const { return closures_; }

  /// Gaussian log likelihood of the gaps if the closures were `measured`. The stated variances of
  /// odometry and closures are multiplied by the factors that fit best. Appends the errors of
  /// predictions with these factors to `errors`. O(closures^3).
  double log_likelihood(const std::vector<Pose>& measured, PredictionError* errors = nullptr) const;

 private:
  using Logarithms = std::array<double, 2>;  // of the factors

  Eigen::VectorXd gaps(const std::vector<Pose>& measured) const;
  Eigen::MatrixXd covariance(const Logarithms& factors) const;
  double log_likelihood_of(const Eigen::VectorXd& values, const Logarithms& factors) const;
  double pattern_search(const Eigen::VectorXd& values, Logarithms& at) const;
  void add_errors(const Eigen::VectorXd& values,
                  const Logarithms& factors,
                  PredictionError& errors) const;

  std::vector<const Edge*> closures_;
  const Chain& chain_;
  Eigen::MatrixXd of_odometry_, of_closures_;  ///< covariances as stated
};

}  // namespace loopbench::metrics
