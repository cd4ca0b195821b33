/// Selection of keyframes during tracking.
#pragma once

#include <cstddef>
#include <cstdint>

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

/// Maximum over all criteria of the ratio of value and threshold. A frame becomes a keyframe if
/// this reaches novelty_due().
double novelty(const FrameRelation& view);

/// Novelty threshold for a new keyframe. With a `target` above 0 it doubles for each keyframe (of
/// `selected`) above the number planned up to `frame` of `frames`, and halves for each missing one;
/// otherwise 1.
double novelty_due(std::int64_t target,
                   std::size_t selected,
                   std::size_t frame,
                   std::size_t frames);

}  // namespace loopbench::rgbd
