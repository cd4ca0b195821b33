/// Odometry between the keyframes of closures.
#pragma once

#include <Eigen/LU>
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

/// The odometry edges have to be complete. O(keyframes).
inline Chain chain_of(const Problem& problem) {
  Chain out{{Pose{}}, {0.0}, {Matrix6::Zero()}};
  for (const Edge& step : problem.odometry) {
    out.poses.push_back(normalized(out.poses.back() * step.from_from_to));
    out.lengths.push_back(out.lengths.back() + step.from_from_to.translation.norm());
    const Matrix6 to_first = adjoint(out.poses.back());
    out.covariances.push_back(out.covariances.back() +
                              to_first * step.information.inverse() * to_first.transpose());
  }
  return out;
}

/// Distance between the end of the odometry along a loop and the closure [m].
inline double gap_of(const Edge& closure, const Chain& chain) {
  const Pose gap = closure.from_from_to.inverse() * chain.between(closure.from, closure.to);
  return gap.translation.norm();
}

}  // namespace loopbench::metrics
