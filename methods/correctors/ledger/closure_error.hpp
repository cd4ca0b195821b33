/// Error of a closure against a prediction of its relative pose.
#pragma once

#include <Eigen/Cholesky>
#include <cmath>

#include "methods/solvers/groups/scaled_pose.hpp"

namespace loopbench::methods {

struct ClosureError {
  double metres = 0.0;   ///< distance between the predicted and the measured position of its end
  double degrees = 0.0;  ///< angle between the predicted and the measured rotation, 0 to 180
  /// Squared Mahalanobis distance per degree of freedom (3 if the problem is planar, else 6) [-].
  /// The covariance is that of the prediction and of the closure, as stated.
  double chi2 = 0.0;
};

/// The error Exp(e) = Z^-1 X_from^-1 X_to with its covariance.
template <class G>
ClosureError closure_error(const typename G::Tangent& error, const typename G::Square& covariance) {
  const Pose gap = G::to_scaled_pose(G::exp(error)).pose;
  const double chi2 = error.dot(covariance.llt().solve(error));
  return {gap.translation.norm(), log_so3(gap.rotation).norm() * 180.0 / M_PI, chi2 / G::kDof};
}

}  // namespace loopbench::methods
