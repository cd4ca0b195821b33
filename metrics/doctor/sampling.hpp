/// Looks at a bounded number of poses, so that checks cost the same for files of any length.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "datasets/core/interpolate.hpp"
#include "datasets/core/trajectory.hpp"
#include "datasets/core/upper_median.hpp"
#include "metrics/pairing/association.hpp"

namespace loopbench::metrics {

/// Most poses that one check compares: medians of so many are accurate to some per cent, and sixty
/// repairs of so many cost as much as reading 10^4 poses.
inline constexpr std::size_t kMostPoses = 300;

inline constexpr std::size_t kFewestCommonPoses = 20;  ///< fewer cannot be checked
inline constexpr std::size_t kListed = 5;              ///< examples in a message
inline constexpr double kFileRounding = 1e-9;          ///< of numbers in files [m], [rad]
inline constexpr double kNoNoise = 1e-6;      ///< smaller errors are not measured [m], [rad]
inline constexpr double kLeastOffset = 0.02;  ///< association tolerance of stamps [s]
inline constexpr double kUsualGaps = 10.0;    ///< keyframes are that many intervals apart

/// Median; 0 for an empty list.
inline double median_value(std::vector<double> values) {
  return values.empty() ? 0.0 : upper_median(values);
}

/// Step with which at most `most` of `size` items are chosen.
inline std::size_t even_step(std::size_t size, std::size_t most) { return size / (most + 1) + 1; }

/// Median of at most kMostPoses evenly chosen intervals [s]; 0 below two poses. O(1).
inline double usual_interval(const Trajectory& poses) {
  std::vector<double> intervals;
  const std::size_t step = even_step(poses.size(), kMostPoses);
  for (std::size_t i = 1; i < poses.size(); i += step) {
    intervals.push_back(poses[i].stamp - poses[i - 1].stamp);
  }
  return median_value(std::move(intervals));
}

/// Longest time between poses across which they are interpolated [s]: keyframes can be seconds
/// apart. O(1).
inline double longest_gap(const Trajectory& poses) {
  return std::max(1.0, kUsualGaps * usual_interval(poses));
}

/// Index of the first pose that is not before `stamp`; the number of poses if there is none.
/// O(log n).
inline std::size_t first_from(const Trajectory& poses, double stamp) {
  const auto found = std::ranges::lower_bound(poses, stamp, {}, &StampedPose::stamp);
  return static_cast<std::size_t>(found - poses.begin());
}

/// Pose at any time, interpolated across gaps of at most `max_gap` [s]. O(log n).
inline std::optional<Pose> pose_near(const Trajectory& poses, double stamp, double max_gap) {
  std::size_t after = first_from(poses, stamp);
  return pose_at(poses, stamp, max_gap + kStampRounding, after);
}

/// At most `most` poses of the estimate in the reference's time, evenly chosen, with the reference
/// interpolated at stamp + offset; without those outside the reference or in its gaps. Constant
/// rotations for those of positions alone. O(log n).
inline Paired common_poses(const Trajectory& reference,
                           const Trajectory& estimate,
                           double offset = 0.0,
                           std::size_t most = kMostPoses) {
  Paired out;
  if (reference.empty()) return out;
  const double gap = longest_gap(reference);
  const auto completed = [](Pose pose) {
    if (!has_rotation(pose)) pose.rotation = Rotation::Identity();
    return pose;
  };
  const std::size_t begin = first_from(estimate, reference.front().stamp - offset);
  const std::size_t end =
      std::min(estimate.size(), first_from(estimate, reference.back().stamp - offset) + 1);
  for (std::size_t i = begin; i < end; i += even_step(end - begin, most)) {
    const auto& [stamp, pose] = estimate[i];
    const auto found = pose_near(reference, stamp + offset, gap);
    if (!found) continue;
    out.reference.push_back({stamp + offset, completed(*found)});
    out.estimate.push_back({stamp, completed(pose)});
  }
  return out;
}

inline double duration(const Trajectory& poses) { return poses.back().stamp - poses.front().stamp; }

/// Length of the common range [s]; negative: the distance between the ranges.
inline double overlap(const Trajectory& a, const Trajectory& b) {
  return std::min(a.back().stamp, b.back().stamp) - std::max(a.front().stamp, b.front().stamp);
}

/// Whether the stamps are small whole numbers, as those of rows or frames. O(n).
inline bool has_frame_indices(const Trajectory& poses) {
  constexpr double kMost = 1e6;  // Unix time is larger
  return std::ranges::all_of(poses, [](const StampedPose& pose) {
    return pose.stamp == std::round(pose.stamp) && std::abs(pose.stamp) < kMost;
  });
}

}  // namespace loopbench::metrics
