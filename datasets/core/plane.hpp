/// Motion in one plane: wheeled robots, and files that contain x, y and heading only.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "datasets/core/rotation_between.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

enum class Planar { automatic, yes, no };
inline auto choices(Planar) {
  return std::array{std::pair{"auto", Planar::automatic},
                    std::pair{"yes", Planar::yes},
                    std::pair{"no", Planar::no}};
}

/// The unit normal of a plane of motion. It has the same coordinates in the body at every pose.
struct MotionPlane {
  Vector3 in_body;
  Vector3 in_world;
};

/// Rounding errors of files with six digits [m], [rad]; also per metre from the first pose.
inline constexpr double kPlaneRounding = 1e-5, kPlaneRoundingPerMetre = 1e-6;

/// The normal in the world at a pose. Positions without rotation have the axes of the world.
inline Vector3 normal_at(const Pose& pose, const Vector3& in_body) {
  return has_rotation(pose) ? pose.rotation * in_body : in_body;
}

/// Whether the pose is in the plane through `origin` within rounding. A relative pose keeps the
/// plane if it is in {in_body, in_body} through zero.
inline bool is_in_plane(const Pose& pose, const MotionPlane& plane, const Vector3& origin) {
  const Vector3 d = pose.translation - origin;
  return (normal_at(pose, plane.in_body) - plane.in_world).squaredNorm() <=
             kPlaneRounding * kPlaneRounding &&
         std::abs(plane.in_world.dot(d)) <= kPlaneRounding + kPlaneRoundingPerMetre * d.norm();
}

/// Returns the plane with this normal of the body, if all poses are in it. O(n).
inline std::optional<MotionPlane> plane_with(const Trajectory& poses, const Vector3& in_body) {
  const Pose& first = poses.front().world_from_body;
  const MotionPlane out{in_body, normal_at(first, in_body)};
  const bool is_plane = std::ranges::all_of(poses, [&](const StampedPose& each) {
    return is_in_plane(each.world_from_body, out, first.translation);
  });
  return is_plane ? std::optional(out) : std::nullopt;
}

/// Returns the plane in which all poses lie and about whose normal they rotate, within rounding. If
/// there are several, as for a straight line without rotation, the one with the normal z, y or x of
/// the body, in this order. None for fewer than three poses and for a body at rest. O(n), bounded
/// for most spatial motions.
inline std::optional<MotionPlane> motion_plane(const Trajectory& poses) {
  constexpr double kRest = 1e-3;  // [m]
  if (poses.size() < 3) return std::nullopt;
  const Pose& first = poses.front().world_from_body;
  if (std::ranges::all_of(poses, [&](const StampedPose& each) {
        return (each.world_from_body.translation - first.translation).norm() < kRest;
      })) {
    return std::nullopt;
  }
  for (const int axis : {2, 1, 0}) {
    if (auto found = plane_with(poses, Vector3::Unit(axis))) return found;
  }
  if (lacks_rotations(poses)) return std::nullopt;
  Vector3 axis = Vector3::Zero();  // of the largest rotation, in a body that is mounted askew
  const std::size_t step = 1 + poses.size() / 1000;  // bounds the cost for spatial motion
  for (std::size_t i = 0; i < poses.size(); i += step) {
    const Vector3 v = (first.rotation.conjugate() * poses[i].world_from_body.rotation).vec();
    if (v.squaredNorm() > axis.squaredNorm()) axis = v;
  }
  if (axis.norm() <= kPlaneRounding) return std::nullopt;
  Eigen::Index main = 0;
  axis.cwiseAbs().maxCoeff(&main);
  return plane_with(poses, (axis[main] > 0.0 ? 1.0 : -1.0) * axis.normalized());
}

/// Returns the plane whose normal is the axis z, y or x of the body that is the most constant in
/// the world; `in_body`: or this one. Of positions without rotation: the axis z, y or x of the
/// world along which they hardly vary, or vary least. Not for an empty list. O(n).
inline MotionPlane nearest_plane(const Trajectory& poses,
                                 const std::optional<Vector3>& in_body = {}) {
  MotionPlane out;
  if (lacks_rotations(poses)) {
    Vector3 low = poses.front().world_from_body.translation, high = low;
    for (const StampedPose& each : poses) {
      low = low.cwiseMin(each.world_from_body.translation);
      high = high.cwiseMax(each.world_from_body.translation);
    }
    constexpr double kFlat = 0.1;  // of the largest extent; a straight run varies least sideways
    const Vector3 extent = high - low;
    int axis = 2;
    for (const int other : {1, 0}) {
      if (extent[axis] > kFlat * extent.maxCoeff() && extent[other] < extent[axis]) axis = other;
    }
    return {Vector3::Unit(axis), Vector3::Unit(axis)};
  }
  double longest = -1.0;
  for (const int axis : {2, 1, 0}) {
    const Vector3 normal = in_body.value_or(Vector3::Unit(axis));
    Vector3 sum = Vector3::Zero();
    for (const StampedPose& each : poses) sum += normal_at(each.world_from_body, normal);
    if (sum.norm() <= longest * (1.0 + 1e-9)) continue;
    longest = sum.norm();
    out = {normal, sum.normalized()};
  }
  return out;
}

/// Moves the pose to the plane through `origin` by the shortest translation and rotation.
inline Pose moved_to_plane(Pose pose, const MotionPlane& plane, const Vector3& origin) {
  pose.translation -= plane.in_world * plane.in_world.dot(pose.translation - origin);
  if (!has_rotation(pose)) return pose;
  const Vector3 normal = pose.rotation * plane.in_body;
  pose.rotation = rotation_between(normal, plane.in_world) * pose.rotation;
  return normalized(pose);
}

/// Moves all poses to the plane through the first one. O(n).
inline void move_to_plane(Trajectory& poses, const MotionPlane& plane) {
  if (poses.empty()) return;
  const Vector3 origin = poses.front().world_from_body.translation;
  for (auto& [stamp, pose] : poses) pose = moved_to_plane(pose, plane, origin);
}

}  // namespace loopbench
