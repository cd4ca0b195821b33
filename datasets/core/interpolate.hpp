/// Interpolation between two poses: linear with SLERP.
#pragma once

#include <cstddef>
#include <optional>

#include "datasets/core/se3.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// Spherical linear interpolation along the shorter arc; u = 0 returns a, u = 1 returns b. For an
/// angle of exactly pi, one of the two arcs is used.
inline Rotation slerp(const Rotation& a, const Rotation& b, double u) {
  return a * exp_so3(u * log_so3(a.conjugate() * b));
}

/// Interpolation in SO(3) x R^3: linear in position, SLERP in rotation.
inline Pose interpolate(const Pose& a, const Pose& b, double u) {
  return {slerp(a.rotation, b.rotation, u), a.translation + u * (b.translation - a.translation)};
}

/// Pose at `stamp`, between those of `a` and `b`.
inline Pose interpolate(const StampedPose& a, const StampedPose& b, double stamp) {
  return interpolate(a.world_from_body, b.world_from_body, (stamp - a.stamp) / (b.stamp - a.stamp));
}

/// Pose of `poses` at `stamp`, interpolated in gaps of at most `max_gap` [s]; nothing outside.
/// `after` is at most the index of the first pose not before `stamp`, to which it moves: requests
/// in the order of time cost O(n + m).
inline std::optional<Pose> pose_at(const Trajectory& poses,
                                   double stamp,
                                   double max_gap,
                                   std::size_t& after) {
  while (after < poses.size() && poses[after].stamp < stamp) ++after;
  if (after == poses.size()) return std::nullopt;
  if (poses[after].stamp == stamp) return poses[after].world_from_body;
  if (after == 0 || poses[after].stamp - poses[after - 1].stamp > max_gap) return std::nullopt;
  return interpolate(poses[after - 1], poses[after], stamp);
}

}  // namespace loopbench
