/// A rigid transform. Names state both frames: `world_from_body * body_from_camera`.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "datasets/core/so3.hpp"

namespace loopbench {

/// Seven doubles without padding, so that a StampedPose fills one cache line.
struct Pose {
  Rotation rotation = Rotation::Identity();  ///< unit
  Vector3 translation = Vector3::Zero();     ///< [m]

  Pose inverse() const {
    const Rotation inverse_rotation = rotation.conjugate();
    return {inverse_rotation, -(inverse_rotation * translation)};
  }
};

inline Pose operator*(const Pose& a_from_b, const Pose& b_from_c) {
  return {a_from_b.rotation * b_from_c.rotation,
          a_from_b.rotation * b_from_c.translation + a_from_b.translation};
}

inline Vector3 operator*(const Pose& a_from_b, const Vector3& point_in_b) {
  return a_from_b.rotation * point_in_b + a_from_b.translation;
}

/// The rotation of a pose that is only a position (total station, GNSS antenna): not a number, so
/// that no rotation can be computed from it by mistake.
inline Rotation no_rotation() {
  return Rotation(Eigen::Vector4d::Constant(std::numeric_limits<double>::quiet_NaN()));
}

inline bool has_rotation(const Pose& pose) { return !std::isnan(pose.rotation.w()); }

/// Renormalises the quaternion, which long products move away from unit norm.
inline Pose normalized(Pose pose) {
  pose.rotation.normalize();
  return pose;
}

inline bool is_finite(const Pose& pose) {
  return pose.rotation.coeffs().allFinite() && pose.translation.allFinite();
}

/// Whether the distance is at most `metres` [m] and the rotation angle at most `radians` [rad].
inline bool is_close(const Pose& a, const Pose& b, double metres, double radians) {
  return (a.translation - b.translation).norm() <= metres &&
         angle_between(a.rotation, b.rotation) <= radians;
}

/// A pose with the digits of its file: the upper 3 x 4 block of world_from_body [m]. Its left 3 x 3
/// block is orthonormal only to the printed digits. It is needed to reproduce tools that use the
/// matrix without normalising it (KITTI devkit); otherwise use Pose.
using PoseMatrix = Eigen::AffineCompact3d;

}  // namespace loopbench
