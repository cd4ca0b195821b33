/// Likelihood of neighbouring loops together, with fitted sizes of the noise.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "metrics/doctor/closure_chain.hpp"

namespace loopbench::metrics {

/// Covariances of the composed odometry that translations and rotations of the steps cause, in the
/// frame of the first keyframe.
using StepCovariances = std::array<std::vector<Matrix6>, 2>;

/// O(keyframes).
StepCovariances step_covariances(const Chain& chain);

/// Median error with which the odometry and the other closures of a group predict a closure.
struct PredictionError {
  std::vector<double> metres;
  std::vector<double> radians;
};

/// A few closures with the odometry that their loops share, which explains a part of their gaps
/// together.
class LoopGroup {
 public:
  LoopGroup(std::vector<const Edge*> closures, const Chain& chain, const StepCovariances& noise);

  const std::vector<const Edge*>& closures() const { return closures_; }
  /// Number of components of rotations that are not zero: 1 of a planar graph.
  double rotations() const { return rotations_; }

  /// Gaussian log likelihood of the gaps if the closures were `measured`. The variances of
  /// translations and rotations of odometry and closures are multiplied by the factors that fit
  /// best. -infinity if a gap leaves the plane of the closures as they are. Appends the errors of
  /// predictions with these factors to `errors`. O(closures^3).
  double log_likelihood(const std::vector<Pose>& measured, PredictionError* errors = nullptr) const;

 private:
  using Logarithms = std::array<double, 4>;  // of the factors

  Eigen::VectorXd gaps(const std::vector<Pose>& measured) const;
  Eigen::MatrixXd covariance(const Logarithms& factors) const;
  double log_likelihood_of(const Eigen::VectorXd& values, const Logarithms& factors) const;
  double pattern_search(const Eigen::VectorXd& values, Logarithms& at) const;
  void add_errors(const Eigen::VectorXd& values,
                  const Logarithms& factors,
                  PredictionError& errors) const;

  std::vector<const Edge*> closures_;
  const Chain& chain_;
  std::vector<Eigen::Index> kept_;  ///< components of the gaps
  double translations_ = 0.0, rotations_ = 0.0;
  std::array<Eigen::MatrixXd, 4> covariances_;  ///< for factors of 1
};

}  // namespace loopbench::metrics
