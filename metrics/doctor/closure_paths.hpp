/// Closures against the shortest path between their keyframes, over odometry and other closures.
#pragma once

#include <vector>

#include "metrics/doctor/closure_chain.hpp"

namespace loopbench::metrics {

/// Difference of a closure and the shortest path that does not use it.
struct PathGap {
  const Edge* closure = nullptr;
  double distance = 0.0;  ///< of the ends [m]
  double length = 0.0;    ///< of the path; a closure on it counts as 2 m [m]
};

/// One gap for each closure that is not in `without`: first of an even sample, then of those that
/// contradict the odometry most. Drift is smaller along these paths than along the odometry. Stops
/// after 5e4 visited keyframes, so that the list can be incomplete. The odometry has to be a chain.
/// O((keyframes + closures) log).
std::vector<PathGap> path_gaps(const Problem& problem,
                               const Chain& chain,
                               const std::vector<const Edge*>& without = {});

}  // namespace loopbench::metrics
