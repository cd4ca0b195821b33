/// Another run at the stamps of the keyframes.
#pragma once

#include <vector>

#include "datasets/core/interpolate.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// Poses of a run at keyframe stamps, where available.
struct RunAtKeyframes {
  Trajectory run;
  std::vector<std::size_t> keyframe;  ///< keyframe index of each pose
};

inline RunAtKeyframes at_keyframes(const Trajectory& keyframes,
                                   const Trajectory& run,
                                   const InterpolationLimits& reach) {
  const auto poses = poses_at(run, stamps(keyframes), reach);
  RunAtKeyframes out;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    if (!poses[i]) continue;
    out.run.push_back({keyframes[i].stamp, *poses[i]});
    out.keyframe.push_back(i);
  }
  return out;
}

}  // namespace loopbench
