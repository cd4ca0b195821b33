#include "metrics/trajectory/projection.hpp"

#include "metrics/numerics/euler.hpp"

namespace loopbench::metrics {

void project(Trajectory& trajectory, ProjectionPlane plane) {
  if (plane == ProjectionPlane::none) return;
  const int across = plane == ProjectionPlane::xy ? 2 : plane == ProjectionPlane::xz ? 1 : 0;
  for (auto& [stamp, pose] : trajectory) {
    const auto [roll, pitch, yaw] = euler(pose.rotation);
    pose.translation[across] = 0.0;
    pose.rotation = exp_so3(Vector3(roll, pitch, yaw)[across] * Vector3::Unit(across));
  }
}

}  // namespace loopbench::metrics
