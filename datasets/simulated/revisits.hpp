/// Where a path comes back to a place it has seen.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench {

struct SamePlace {
  double radius;   ///< [m]
  double angle;    ///< [rad]
  double min_gap;  ///< [s]

  /// Near enough and looking alike; says nothing about time.
  bool holds(const Pose& a, const Pose& b) const { return is_close(a, b, radius, angle); }
};

/// For each pose that has one, the nearest earlier pose of the same place at least min_gap before,
/// as (from, to), ascending in `to`. Of a place seen over and over only its latest visits are
/// looked at, so the cost stays O(poses). radius > 0.
std::vector<std::pair<std::size_t, std::size_t>> revisits(const Trajectory& truth,
                                                          const SamePlace& same);

}  // namespace loopbench
