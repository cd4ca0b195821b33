/// Projection of a trajectory onto a coordinate plane, as evo's --project_to_plane.
#pragma once

#include "datasets/core/trajectory.hpp"
#include "metrics/numerics/euler.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench::metrics {

/// Sets the coordinate normal to the plane to zero and keeps of each orientation only its Euler
/// angle about the normal (euler.hpp; for xz that is the pitch, limited to +-90 degrees). evo
/// core/trajectory.py:200-230. O(n). No effect for `none`.
inline void project(Trajectory& trajectory, ProjectionPlane plane) {
  if (plane == ProjectionPlane::none) return;
  int across = plane == ProjectionPlane::xz ? 1 : 0;
  if (plane == ProjectionPlane::xy) across = 2;
  for (auto& [stamp, pose] : trajectory) {
    const auto [roll, pitch, yaw] = euler(pose.rotation);
    pose.translation[across] = 0.0;
    pose.rotation = exp_so3(Vector3(roll, pitch, yaw)[across] * Vector3::Unit(across));
  }
}

}  // namespace loopbench::metrics
