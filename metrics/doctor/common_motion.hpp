/// Poses of reference and estimate at the same times.
#pragma once

#include <algorithm>
#include <vector>

#include "datasets/core/upper_median.hpp"
#include "metrics/pairing/association.hpp"

namespace loopbench::metrics {

/// Median; 0 for an empty list.
inline double median_value(std::vector<double> values) {
  return values.empty() ? 0.0 : upper_median(values);
}

/// Median time between poses [s]; 0 below two poses. O(n).
inline double usual_interval(const Trajectory& poses) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    intervals.push_back(poses[i].stamp - poses[i - 1].stamp);
  }
  return median_value(std::move(intervals));
}

/// Longest time between poses of the reference across which it is interpolated [s]. O(n).
inline double longest_gap(const Trajectory& reference) {
  return std::max(1.0, 10.0 * usual_interval(reference));
}

/// At most 1500 poses of the estimate, evenly chosen, with the reference interpolated at stamp +
/// offset; without those outside the reference or in its gaps above 1 s (or ten times its median
/// interval). O(n + m).
inline Paired common_poses(const Trajectory& reference,
                           const Trajectory& estimate,
                           double offset = 0.0) {
  constexpr std::size_t kMost = 1500;
  Trajectory few;
  const std::size_t step = estimate.size() / (kMost + 1) + 1;
  for (std::size_t i = 0; i < estimate.size(); i += step) few.push_back(estimate[i]);
  return interpolate_reference(reference, few, longest_gap(reference), offset);
}

}  // namespace loopbench::metrics
