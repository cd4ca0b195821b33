/// Between two poses: straight line with SLERP, or along one screw.
#pragma once

#include "datasets/core/se3.hpp"

namespace loopbench {

/// Shortest great arc; u = 0 gives a, u = 1 gives b. Angles of exactly pi take one of two arcs.
inline Rotation slerp(const Rotation& a, const Rotation& b, double u) {
  return a * exp_so3(u * log_so3(a.conjugate() * b));
}

/// Position on the straight line, attitude on the great arc: SO(3) x R^3.
inline Pose interpolate(const Pose& a, const Pose& b, double u) {
  return {slerp(a.rotation, b.rotation, u), a.translation + u * (b.translation - a.translation)};
}

/// Constant body twist from a to b: geodesic of SE(3), right for a wheeled arc.
inline Pose interpolate_screw(const Pose& a, const Pose& b, double u) {
  return a * exp_se3(u * log_se3(a.inverse() * b));
}

}  // namespace loopbench
