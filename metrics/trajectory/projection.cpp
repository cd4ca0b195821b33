#include "metrics/trajectory/projection.hpp"

#include "metrics/numerics/euler.hpp"

namespace loopbench::metrics {

void project(Trajectory& trajectory, Plane plane) {
  if (plane == Plane::none) return;
  const int across = plane == Plane::xy ? 2 : plane == Plane::xz ? 1 : 0;
  for (auto& [stamp, pose] : trajectory) {
    const auto [roll, pitch, yaw] = euler(pose.rotation);
    pose.translation[across] = 0.0;
    pose.rotation = exp_so3(Vector3(roll, pitch, yaw)[across] * Vector3::Unit(across));
  }
}

}  // namespace loopbench::metrics
