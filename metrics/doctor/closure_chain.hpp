/// Closures against the odometry between their keyframes.
#pragma once

#include <cmath>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench::metrics {

/// Composed odometry, its length and its covariance to first order.
struct Chain {
  std::vector<Pose> poses;           ///< first_from_keyframe
  std::vector<double> lengths;       ///< up to each keyframe [m]
  std::vector<Matrix6> covariances;  ///< of each pose, as a twist in the frame of the first

  Pose between(std::size_t i, std::size_t j) const { return poses[i].inverse() * poses[j]; }
  double length(std::size_t i, std::size_t j) const { return std::abs(lengths[j] - lengths[i]); }
};

/// O(keyframes).
Chain chain_of(const Problem& problem);

/// Distance between the end of the odometry along a loop and the closure [m].
double gap_of(const Edge& closure, const Chain& chain);

/// The closures sorted by the later of their keyframes. O(closures log).
std::vector<const Edge*> sorted_by_end(const std::vector<Edge>& closures);

}  // namespace loopbench::metrics
