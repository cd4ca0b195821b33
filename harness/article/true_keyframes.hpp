/// The reference at the keyframes of a run.
#pragma once

#include "datasets/core/polyline.hpp"
#include "harness/article/paper_run.hpp"

namespace loopbench::harness {

/// Poses of the evaluated reference at the keyframe stamps that it covers. O(n + m).
inline Trajectory true_keyframes(const PaperCell& raw) {
  const Polyline truth(raw.dense.reference);
  std::vector<double> known;
  for (const StampedPose& pose : raw.keyframes) {
    if (pose.stamp >= truth.start() && pose.stamp <= truth.end()) known.push_back(pose.stamp);
  }
  return truth.sample(known);
}

}  // namespace loopbench::harness
