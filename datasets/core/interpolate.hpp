/// Interpolation between two poses: linear with SLERP.
#pragma once

#include "datasets/core/se3.hpp"

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

}  // namespace loopbench
