/// The usual time between poses.
#pragma once

#include <vector>

#include "datasets/core/trajectory.hpp"
#include "datasets/core/upper_median.hpp"

namespace loopbench {

/// Median time between consecutive poses [s]; 0 below two poses. O(n).
inline double median_interval(const Trajectory& poses) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    intervals.push_back(poses[i].stamp - poses[i - 1].stamp);
  }
  return intervals.empty() ? 0.0 : upper_median(intervals);
}

}  // namespace loopbench
