/// Detection of trajectories that hold only positions, without or with a placeholder orientation.
#pragma once

#include <algorithm>

#include "datasets/core/trajectory.hpp"

namespace loopbench::metrics {

inline constexpr double kSameAttitude =
    1e-9;  // [rad]; interpolating equal orientations rounds to 1e-16
inline constexpr std::size_t kEvidence = 10;  // poses
inline constexpr double kStraight = 1e-6;     // largest ratio of width to length of a straight line

inline bool is_on_one_line(const Trajectory& trajectory) {
  const Vector3 first = trajectory.front().world_from_body.translation;
  Vector3 farthest = Vector3::Zero();
  for (const auto& [stamp, pose] : trajectory) {
    const Vector3 displacement = pose.translation - first;
    if (displacement.squaredNorm() > farthest.squaredNorm()) farthest = displacement;
  }
  const double length = farthest.norm();
  if (length == 0.0) return true;
  const Vector3 direction = farthest / length;
  return std::all_of(trajectory.begin(), trajectory.end(), [&](const StampedPose& pose) {
    const Vector3 displacement = pose.world_from_body.translation - first;
    return displacement.cross(direction).norm() <= kStraight * length;
  });
}

/// True if the trajectory lacks_rotations(), or if all orientations are equal (to 1e-9 rad)
/// although the path is curved. A body that really keeps its orientation on a straight path is not
/// affected; one that moves along a curve without rotating would be misclassified. False for fewer
/// than ten poses. O(n).
inline bool is_position_only(const Trajectory& trajectory) {
  if (lacks_rotations(trajectory)) return true;
  if (trajectory.size() < kEvidence) return false;
  const Rotation& first = trajectory.front().world_from_body.rotation;
  for (const auto& [stamp, pose] : trajectory) {
    if (angle_between(first, pose.rotation) > kSameAttitude) return false;
  }
  return !is_on_one_line(trajectory);
}

}  // namespace loopbench::metrics
