/// Direction of travel, robust to the jitter of a dense reference.
#pragma once

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
std::vector<Chord> chords(const Trajectory& trajectory, double window);

}  // namespace loopbench::metrics
