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
  std::vector<Matrix6> steps;        ///< stated covariance of each edge

  Pose between(std::size_t i, std::size_t j) const { return poses[i].inverse() * poses[j]; }
  double length(std::size_t i, std::size_t j) const;
  /// Covariance of between(i, j), as a twist in the frame of j.
  Matrix6 covariance(std::size_t i, std::size_t j) const;
};

/// O(keyframes).
Chain chain_of(const Problem& problem);

/// The same with the blocks of translation and rotation of all covariances exchanged. O(keyframes).
Chain exchanged(const Chain& chain);

/// Squared errors over stated variances; 1 on average if these are true.
struct SquaredError {
  double translation = 0.0;
  double rotation = 0.0;
  double whole = 0.0;  ///< Mahalanobis distance per dimension
};

/// Difference of the odometry between its keyframes and a closure, over the
/// covariance of both, read with exchanged blocks if `is_exchanged`.
SquaredError closure_error(const Edge& closure, const Chain& chain, bool is_exchanged);

/// Distance between the end of the odometry along a loop and the closure [m].
double gap_of(const Edge& closure, const Chain& chain);

/// Median of each part.
SquaredError median_error(const std::vector<SquaredError>& all);

/// Two closures between the same two sections of the chain, so that the drift between these
/// cancels.
struct Neighbours {
  const Edge* a = nullptr;
  const Edge* b = nullptr;
};

/// At most one neighbour for each closure. O(closures).
std::vector<Neighbours> neighbours_of(const std::vector<Edge>& closures, const Chain& chain);

/// Difference of closure `a` and the path over closure `b`; zero without noise.
Twist neighbour_residual(const Neighbours& pair, const Chain& chain);

/// The same over the covariance of both closures and of the odometry between them, for each pair.
std::vector<SquaredError> neighbour_errors(const std::vector<Neighbours>& pairs,
                                           const Chain& chain);

}  // namespace loopbench::metrics
