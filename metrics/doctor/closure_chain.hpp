/// Closures against the odometry between their keyframes.
#pragma once

#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench::metrics {

/// Composed odometry, its length and its covariance to first order.
struct Chain {
  std::vector<Pose> poses;           ///< first_from_keyframe
  std::vector<double> lengths;       ///< up to each keyframe [m]
  std::vector<Matrix6> covariances;  ///< of each pose, as a twist in the frame of the first

  Pose between(std::size_t i, std::size_t j) const { return poses[i].inverse() * poses[j]; }
  double length(std::size_t i, std::size_t j) const;
  /// Covariance of between(i, j), as a twist in the frame of j.
  Matrix6 covariance(std::size_t i, std::size_t j) const;
};

/// `exchanged`: read the covariances with their blocks of translation and rotation exchanged.
/// O(keyframes).
Chain chain_of(const Problem& problem, bool exchanged);

/// Squared errors over stated variances; 1 on average if these are true.
struct SquaredError {
  double translation = 0.0;
  double rotation = 0.0;
  double whole = 0.0;  ///< Mahalanobis distance per dimension
};

/// Difference of the odometry between its keyframes and a closure (or its inverse), over the
/// covariance of both.
SquaredError closure_error(const Edge& closure, const Chain& chain, bool exchanged, bool inverted);

/// Median of each part.
SquaredError median_error(const std::vector<SquaredError>& all);

/// Two closures between the same two stretches of the chain, so that the drift between these
/// cancels.
struct Neighbours {
  const Edge* a = nullptr;
  const Edge* b = nullptr;
};

/// At most one neighbour for each closure. O(closures).
std::vector<Neighbours> neighbours_of(const std::vector<Edge>& closures, const Chain& chain);

/// Difference of closure `a` and the path over closure `b`; zero without noise.
Twist neighbour_residual(const Neighbours& pair, const Chain& chain, bool inverted);

}  // namespace loopbench::metrics
