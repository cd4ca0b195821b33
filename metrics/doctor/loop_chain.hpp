/// Composed odometry of a problem, and the paths over which it and other closures predict closures.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/solvers/groups/scaled_pose.hpp"

namespace loopbench::metrics {

using methods::ScaledPose;

struct Chain {
  std::vector<ScaledPose> poses;     ///< first_from_keyframe
  std::vector<double> distances;     ///< travelled up to each keyframe [m]
  std::vector<double> steps;         ///< up to each keyframe; more for steps of a larger variance
  std::vector<Matrix6> covariances;  ///< of each pose, as a twist in the frame of the first
  bool has_scale = false;            ///< some edge has one, so that translations have any scale

  ScaledPose between(std::size_t i, std::size_t j) const {
    const auto& [from, scale] = poses[i];
    Pose out = from.inverse() * poses[j].pose;
    out.translation /= scale;
    return {out, poses[j].scale / scale};
  }
  /// Covariance of between(i, j) as a twist in the frame of j.
  Matrix6 covariance(std::size_t i, std::size_t j) const {
    const Matrix6 to_end = in_scale(1.0 / poses[j].scale) * adjoint(poses[j].pose.inverse());
    const Matrix6 of_steps = covariances[std::max(i, j)] - covariances[std::min(i, j)];
    return to_end * of_steps * to_end.transpose();
  }
  /// Multiplies translations.
  static Matrix6 in_scale(double scale) {
    Matrix6 out = Matrix6::Identity();
    out.diagonal().head<3>().setConstant(scale);
    return out;
  }
  double count(std::size_t i, std::size_t j) const { return std::abs(steps[j] - steps[i]); }
  double distance(std::size_t i, std::size_t j) const {
    return std::abs(distances[j] - distances[i]);
  }
};

/// The odometry edges have to be complete. O(keyframes).
Chain chain_of(const Problem& problem);

using PoseChange = std::function<Pose(const Pose&)>;

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
  /// The kFewestLoops with the least odometry, so that a false one is outvoted; shorter than the
  /// loop.
  std::vector<LoopPath> over_closures;
};

inline constexpr std::size_t kFewestLoops = 3;  ///< one or two fit several explanations

/// Sorted by the ends of the closures, of which at most 200 before and after are compared.
/// O(closures log closures).
std::vector<LoopPaths> loop_paths(const std::vector<Edge>& closures, const Chain& chain);

}  // namespace loopbench::metrics
