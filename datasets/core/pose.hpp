/// A rigid transform. Names state both frames: `world_from_body * body_from_camera`.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
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

/// Normalises a quaternion of a file; false if its norm differs from 1 by more than 1e-2: rounding
/// in the file causes smaller deviations, a wrong column order larger ones. Quaternions that are
/// unit up to rounding are not changed, so that round trips are bit-identical. `off_unit` becomes
/// the largest deviation so far.
inline bool normalise(Rotation& rotation, double& off_unit) {
  constexpr double kTolerance = 1e-2, kRounding = 4e-15;
  const double square = rotation.squaredNorm();
  if (std::abs(square - 1.0) <= kRounding) return true;
  const double norm = std::sqrt(square);
  if (!(std::abs(norm - 1.0) <= kTolerance)) return false;
  off_unit = std::max(off_unit, std::abs(norm - 1.0));
  rotation.coeffs() /= norm;
  return true;
}

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

/// Pose with the exact translation and the rotation nearest to the left 3 x 3 block.
inline Pose pose_of(const PoseMatrix& matrix) {
  return {Rotation(Matrix3(matrix.linear())).normalized(), matrix.translation()};
}

}  // namespace loopbench
