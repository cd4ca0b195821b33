/// When what the camera sees is new enough for a keyframe.
#pragma once

#include <cstdint>

#include "datasets/core/fields.hpp"

namespace loopbench {

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
  visit("keyframes.target", o.target, "about how many are wanted; 0: as the rules say", Between{0});
  visit("keyframes.tracked_min",
        o.tracked_min,
        "share of the last keyframe's points still seen [-]",
        Between{0, 0.99});
  visit("keyframes.common_min", o.common_min, "points still seen of it", Between{1});
  visit("keyframes.parallax_max", o.parallax_max, "way over median depth [-]", Above{0});
  visit("keyframes.angle_max", o.angle_max, "turned since [deg]", Above{0});
  visit("keyframes.time_max", o.time_max, "passed since [s]", Above{0});
}

/// How a frame stands to the last keyframe.
struct View {
  std::size_t points = 0;  ///< that the keyframe saw
  std::size_t common = 0;  ///< of them seen here too
  double way = 0.0;        ///< between the two [m]
  double depth = 1.0;      ///< median here [m]
  double angle = 0.0;      ///< between the two [rad]
  double time = 0.0;       ///< [s]
};

/// The largest of the rules' measures, each 1 at its threshold: a keyframe is due from 1 on.
double novelty(const View& view, const KeyframeOptions& options);

/// The novelty that a keyframe is due at, so that about `target` come out: it
/// doubles for every keyframe too many that were made by now. 1 without a target.
double novelty_due(const KeyframeOptions& options,
                   std::size_t made,
                   std::size_t frame,
                   std::size_t frames);

}  // namespace loopbench
