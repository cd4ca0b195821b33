/// A rigid transform, named by the frames it joins: `world_from_body * body_from_camera`.
#pragma once

#include "datasets/core/so3.hpp"

namespace loopbench {

/// Seven doubles and no padding, so a stamped pose fills one cache line.
struct Pose {
  Rotation rotation = Rotation::Identity();  ///< unit
  Vector3 translation = Vector3::Zero();     ///< [m]

  Pose inverse() const {
    const Rotation back = rotation.conjugate();
    return {back, -(back * translation)};
  }
};

inline Pose operator*(const Pose& a_from_b, const Pose& b_from_c) {
  return {a_from_b.rotation * b_from_c.rotation,
          a_from_b.rotation * b_from_c.translation + a_from_b.translation};
}

inline Vector3 operator*(const Pose& a_from_b, const Vector3& point_in_b) {
  return a_from_b.rotation * point_in_b + a_from_b.translation;
}

/// Long chains of products drift off the unit sphere; this puts them back.
inline Pose normalized(Pose pose) {
  pose.rotation.normalize();
  return pose;
}

inline bool is_finite(const Pose& pose) {
  return pose.rotation.coeffs().allFinite() && pose.translation.allFinite();
}

/// Largest of the two differences is below the tolerances [m], [rad].
inline bool is_close(const Pose& a, const Pose& b, double metres, double radians) {
  return (a.translation - b.translation).norm() <= metres &&
         angle_between(a.rotation, b.rotation) <= radians;
}

}  // namespace loopbench
