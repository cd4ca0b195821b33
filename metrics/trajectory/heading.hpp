/// Direction of travel, robust to the jitter of a dense reference.
#pragma once

#include <algorithm>
#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench::metrics {

/// Chord of the path around a pose.
struct Chord {
  Vector3 displacement = Vector3::Zero();  ///< last minus first position of the window [m]
  double seconds = 0.0;                    ///< last minus first stamp of the window

  bool is_moving(double standing_speed) const {
    return seconds > 0.0 && displacement.norm() > standing_speed * seconds;
  }
};

/// From the first pose at most window / 2 before to the last at most window / 2 after each pose;
/// if poses are sparser, between the neighbours. Stamps must not decrease. O(n).
inline std::vector<Chord> chords(const Trajectory& trajectory, double window) {
  const std::size_t n = trajectory.size();
  std::vector<Chord> out(n);
  std::size_t first = 0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double here = trajectory[i].stamp;
    while (here - trajectory[first].stamp > 0.5 * window) ++first;
    while (last + 1 < n && trajectory[last + 1].stamp - here <= 0.5 * window) ++last;
    const StampedPose& from = trajectory[i > 0 ? std::min(first, i - 1) : 0];
    const StampedPose& to = trajectory[std::min(std::max(last, i + 1), n - 1)];
    out[i].displacement = to.world_from_body.translation - from.world_from_body.translation;
    out[i].seconds = to.stamp - from.stamp;
  }
  return out;
}

}  // namespace loopbench::metrics
