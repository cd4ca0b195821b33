/// Stamps of two files as those of clocks.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "datasets/core/median_interval.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench::metrics {

inline double duration(const Trajectory& poses) { return poses.back().stamp - poses.front().stamp; }

/// Length of the common range [s]; negative: the distance between the ranges.
inline double overlap(const Trajectory& a, const Trajectory& b) {
  return std::min(a.back().stamp, b.back().stamp) - std::max(a.front().stamp, b.front().stamp);
}

inline bool has_frame_indices(const Trajectory& poses) {
  constexpr double kRounding = 1e-6, kMostFirst = 1e6;
  constexpr double kMostStep = 20.0;  // keyframes skip frames
  const double first = poses.front().stamp;
  if (first < 0.0 || first > kMostFirst || median_interval(poses) > kMostStep) return false;
  return std::ranges::all_of(poses, [&](const StampedPose& pose) {
    return std::abs(pose.stamp - std::round(pose.stamp)) < kRounding;
  });
}

/// All digits: stamps are seconds since 1970.
inline std::string stamps_command(double factor, double offset) {
  return fmt::format(
      "traj transform EST --stamp-scale {:.15g} -o NEW, then --offset {:.4f} for NEW",
      factor,
      offset);
}

inline Trajectory restamped(Trajectory poses, double factor, double offset) {
  for (StampedPose& pose : poses) pose.stamp = factor * pose.stamp + offset;
  return poses;
}

}  // namespace loopbench::metrics
