/// Composed odometry of a problem, and the paths over which it and other closures predict closures.
#pragma once

#include <cmath>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/solvers/groups/scaled_pose.hpp"
#include "metrics/doctor/conventions.hpp"

namespace loopbench::metrics {

using methods::ScaledPose;

struct Chain {
  std::vector<ScaledPose> poses;     ///< first_from_keyframe
  std::vector<double> distances;     ///< travelled up to each keyframe [m]
  std::vector<Matrix6> covariances;  ///< of each pose, as a twist in the frame of the first
  bool has_scale = false;            ///< some edge has one, so that translations have any scale

  ScaledPose between(std::size_t i, std::size_t j) const { return poses[i].inverse() * poses[j]; }
  /// Covariance of between(i, j) as a twist in the frame of j.
  Matrix6 covariance(std::size_t i, std::size_t j) const;
  double distance(std::size_t i, std::size_t j) const {
    return std::abs(distances[j] - distances[i]);
  }
  /// Stated variance of the rotation between keyframes, which no frame changes [rad^2].
  double variance(std::size_t i, std::size_t j) const {
    return std::abs((covariances[j] - covariances[i]).diagonal().tail<3>().sum());
  }
};

/// The odometry edges have to be complete. O(keyframes).
Chain chain_of(const Problem& problem);

inline Pose as_stated(const Pose& p) { return p; }

/// A closure, and another one over which a path leads to its end; none: over odometry alone.
struct LoopPath {
  const Edge* closure = nullptr;
  const Edge* over = nullptr;
  Matrix6 covariance = Matrix6::Zero();  ///< of the residual to first order, as stated

  /// Difference of the end of the path from that of the closure, with changed closures.
  Twist residual(const Chain& chain, const PoseChange& change) const;

  /// Chi-squared of the residual per degree of freedom; over odometry whose edges have scales, that
  /// of the rotation, because a drift of the scale moves the ends of loops. O(1).
  double chi_squared(const Chain& chain, const PoseChange& change) const;
};

struct LoopPaths {
  LoopPath odometry;
  /// The kFewestLoops with the least uncertain odometry, so that a false one is outvoted; less
  /// uncertain than the loop.
  std::vector<LoopPath> over_closures;
};

inline constexpr std::size_t kFewestLoops = 3;  ///< one or two fit several explanations

/// Sorted by the ends of the closures, of which at most kMostPoses before and after are compared.
/// O(closures log closures).
std::vector<LoopPaths> loop_paths(const std::vector<Edge>& closures, const Chain& chain);

/// Medians of chi-squared over odometry and over other closures, above zero: the first sees frames,
/// the second no drift. Without enough other closures, both are the first. O(closures).
struct MedianFit {
  double odometry = 0.0, over_closures = 0.0;

  MedianFit(const std::vector<const LoopPaths*>& loops,
            const Chain& chain,
            const PoseChange& change);
};

}  // namespace loopbench::metrics
