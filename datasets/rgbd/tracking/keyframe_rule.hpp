/// Selection of keyframes during tracking.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace loopbench::rgbd {

/// Relation of a frame to the last keyframe.
struct FrameRelation {
  std::size_t points = 0;  ///< number of points observed in the keyframe
  std::size_t common = 0;  ///< number of these points also observed in the frame
  double distance = 0.0;   ///< distance between the two [m]
  double depth = 1.0;      ///< median depth of the frame [m]
  double angle = 0.0;      ///< rotation angle between the two [rad]
  double time = 0.0;       ///< time between the two [s]
};

inline constexpr double kMinTrackedShare = 0.2;  // of the points of the last keyframe [-]
inline constexpr double kMinCommonPoints = 60.0;
inline constexpr double kMaxParallax = 0.15;  // distance over median depth [-]
inline constexpr double kMaxAngle = 15.0;     // [deg]
inline constexpr double kMaxTime = 2.0;       // [s]

/// Maximum over all criteria of the ratio of value and threshold. A frame becomes a keyframe if
/// this reaches novelty_due().
inline double novelty(const FrameRelation& view) {
  const double common = static_cast<double>(view.common);
  const double share = view.points == 0 ? 0.0 : common / static_cast<double>(view.points);
  return std::max({(1.0 - share) / (1.0 - kMinTrackedShare),
                   kMinCommonPoints / std::max(common, 1.0),
                   view.distance / std::max(view.depth, 0.1) / kMaxParallax,
                   view.angle * 180.0 / std::numbers::pi / kMaxAngle,
                   view.time / kMaxTime});
}

/// Novelty threshold for a new keyframe. With a `target` above 0 it doubles for each keyframe (of
/// `selected`) above the number planned up to `frame` of `frames`, and halves for each missing one;
/// otherwise 1.
inline double novelty_due(std::int64_t target,
                          std::size_t selected,
                          std::size_t frame,
                          std::size_t frames) {
  if (target == 0 || frames < 2) return 1.0;
  constexpr double kFactor = 2.0;
  const double share = static_cast<double>(frame) / static_cast<double>(frames - 1);
  const double planned = 1.0 + share * static_cast<double>(target - 1);
  return std::pow(kFactor, static_cast<double>(selected) - planned);
}

}  // namespace loopbench::rgbd
