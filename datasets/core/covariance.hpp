/// Covariances of poses in the fixed axes of the world.
///
/// A covariance is that of the error [d; phi] of a pose: the true position is p + d [m] and the
/// true rotation exp(phi) R [rad], both in the axes of the world, as in messages of ROS. All
/// functions propagate to first order.
#pragma once

#include <algorithm>
#include <vector>

#include "datasets/core/se3.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// Covariance of the same pose in axes rotated by `rotation`, with lengths multiplied by `scale`.
inline Matrix6 rotated(const Matrix6& covariance, const Matrix3& rotation, double scale = 1.0) {
  Matrix6 factor = Matrix6::Zero();
  factor.topLeftCorner<3, 3>() = scale * rotation;
  factor.bottomRightCorner<3, 3>() = rotation;
  return factor * covariance * factor.transpose();
}

/// Rotates and scales all covariances with a world frame that is moved by `pose`. O(n).
inline void rotate(std::vector<Matrix6>& covariances, const Pose& pose, double scale = 1.0) {
  const Matrix3 R = pose.rotation.toRotationMatrix();
  for (Matrix6& covariance : covariances) covariance = rotated(covariance, R, scale);
}

/// Covariance of another point of the body, displaced by `lever` in the axes of the world [m].
inline Matrix6 displaced(const Matrix6& covariance, const Vector3& lever) {
  Matrix6 factor = Matrix6::Identity();
  factor.topRightCorner<3, 3>() = -hat(lever);
  return factor * covariance * factor.transpose();
}

/// Moves the covariances of the poses `before` to another point of the body, whose poses are
/// `after`. Without covariances, nothing happens. O(n).
inline void displace(std::vector<Matrix6>& covariances,
                     const Trajectory& before,
                     const Trajectory& after) {
  for (std::size_t i = 0; i < covariances.size(); ++i) {
    covariances[i] =
        displaced(covariances[i],
                  after[i].world_from_body.translation - before[i].world_from_body.translation);
  }
}

/// The covariance without errors out of the x-y plane of the body: of z, roll and pitch.
inline Matrix6 planar_covariance(const Matrix6& covariance, const Matrix3& world_from_body) {
  const Twist kept = twist({1.0, 1.0, 0.0}, {0.0, 0.0, 1.0});
  const Matrix6 of_body = rotated(covariance, world_from_body.transpose());
  return rotated(kept.asDiagonal() * of_body * kept.asDiagonal(), world_from_body);
}

/// Covariance at `stamp` [s], linear between the neighbouring poses and constant beyond the first
/// and the last. O(log n).
inline Matrix6 covariance_at(const Trajectory& poses,
                             const std::vector<Matrix6>& covariances,
                             double stamp) {
  const auto after = std::ranges::lower_bound(poses, stamp, {}, &StampedPose::stamp);
  const auto i = static_cast<std::size_t>(after - poses.begin());
  if (i == poses.size()) return covariances.back();
  if (i == 0 || after->stamp == stamp) return covariances[i];
  const double share = (stamp - poses[i - 1].stamp) / (after->stamp - poses[i - 1].stamp);
  return (1.0 - share) * covariances[i - 1] + share * covariances[i];
}

}  // namespace loopbench
