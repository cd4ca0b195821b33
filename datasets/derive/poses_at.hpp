/// Poses of a run at given times, where available.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "datasets/core/interpolate.hpp"
#include "datasets/core/knot_span.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

struct InterpolationLimits {
  double max_gap = 0.2;    ///< maximum time between interpolated poses [s]
  double max_diff = 0.02;  ///< otherwise, maximum time difference to the nearest pose [s]
};

/// Returns the index of the nearest pose in time, if it is at most `max_diff` [s] away. O(log n).
inline std::optional<std::size_t> nearest_pose(const Trajectory& run,
                                               double time,
                                               double max_diff) {
  const auto after = std::lower_bound(
      run.begin(), run.end(), time, [](const StampedPose& p, double t) { return p.stamp < t; });
  std::optional<std::size_t> best;
  double best_difference = max_diff;
  const auto compare = [&](Trajectory::const_iterator pose) {
    const double difference = std::abs(pose->stamp - time);
    if (difference > best_difference || (best && difference == best_difference)) return;
    best_difference = difference;
    best = static_cast<std::size_t>(pose - run.begin());
  };
  if (after != run.begin()) compare(after - 1);
  if (after != run.end()) compare(after);
  return best;
}

/// Returns one pose per time, interpolated linearly with SLERP between neighbours, or the nearest
/// pose, or nothing if both are too far away. Times may be in any order. O(n + m) for sorted times.
inline std::vector<std::optional<Pose>> poses_at(const Trajectory& run,
                                                 const std::vector<double>& times,
                                                 const InterpolationLimits& reach) {
  constexpr double kRounding = 1e-6;  // [s]; rounding of printed stamps and of their differences
  std::vector<std::optional<Pose>> out(times.size());
  if (run.empty()) return out;
  const std::vector<double> knots = stamps(run);
  KnotSpan span(knots);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double time = times[k];
    if (run.size() > 1 && time >= knots.front() && time <= knots.back()) {
      const std::size_t i = span.find(time);
      if (knots[i + 1] - knots[i] <= reach.max_gap + kRounding) {
        out[k] = interpolate(run[i], run[i + 1], time);
        continue;
      }
    }
    const auto nearest = nearest_pose(run, time, reach.max_diff);
    if (nearest) out[k] = run[*nearest].world_from_body;
  }
  return out;
}

}  // namespace loopbench
