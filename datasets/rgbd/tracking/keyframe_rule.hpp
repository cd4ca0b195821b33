/// Selection of keyframes during tracking.
#pragma once

#include <cstdint>

#include "datasets/core/fields.hpp"

namespace loopbench::rgbd {

struct KeyframeOptions {
  std::int64_t target = 0;
  double tracked_min = 0.2;
  std::int64_t common_min = 60;
  double parallax_max = 0.15;
  double angle_max = 15.0;  ///< [deg]
  double time_max = 2.0;    ///< [s]
};

template <class Visit>
void fields(KeyframeOptions& o, Visit visit) {
  visit("keyframes.target",
        o.target,
        "approximate number of keyframes; 0: determined by the other options",
        Between{0});
  visit("keyframes.tracked_min",
        o.tracked_min,
        "new keyframe below this share of tracked points of the last keyframe [-]",
        Between{0, 0.99});
  visit("keyframes.common_min",
        o.common_min,
        "new keyframe below this number of tracked points of the last keyframe",
        Between{1});
  visit("keyframes.parallax_max",
        o.parallax_max,
        "new keyframe above this distance to the last one, relative to the median depth [-]",
        GreaterThan{0});
  visit("keyframes.angle_max",
        o.angle_max,
        "new keyframe above this rotation angle to the last one [deg]",
        GreaterThan{0});
  visit("keyframes.time_max",
        o.time_max,
        "new keyframe above this time since the last one [s]",
        GreaterThan{0});
}

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
double novelty(const FrameRelation& view, const KeyframeOptions& options);

/// Novelty threshold for a new keyframe. With options.target it doubles for each keyframe (of
/// `selected`) above the number planned up to `frame` of `frames`, and halves for each missing one;
/// otherwise 1.
double novelty_due(const KeyframeOptions& options,
                   std::size_t selected,
                   std::size_t frame,
                   std::size_t frames);

}  // namespace loopbench::rgbd
