/// Loop detection from images: retrieval by bag of words and geometric verification.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "datasets/core/sequence.hpp"
#include "datasets/images/tracking/tracker.hpp"

namespace loopbench::rgbd {

struct LoopOptions {
  bool enabled = true;
  double min_gap = 5.0;  ///< [s]
  std::int64_t inliers_min = 40;
};

template <class Visit>
void fields(LoopOptions& o, Visit visit) {
  visit("loops.enabled", o.enabled, "detection of loop closures");
  visit("loops.min_gap",
        o.min_gap,
        "minimum time between the keyframes of a loop closure [s]",
        GreaterThan{0});
  visit("loops.inliers_min",
        o.inliers_min,
        "minimum number of inliers of an accepted closure",
        Between{6});
}

struct DetectedLoops {
  std::vector<Edge> closures = {};             ///< sorted by (to, from)
  std::vector<LoopCandidate> candidates = {};  ///< best candidate of each keyframe, sorted by `to`
};

/// Detects loop closures between keyframes. A vocabulary is trained on the descriptors of the
/// keyframes. For each keyframe the most similar keyframes at least min_gap older are retrieved; a
/// candidate is consistent if the previous keyframe retrieved it or one of its neighbours.
/// Candidates are verified by feature matching, RANSAC against the points of the older keyframe,
/// and refinement with the points of its neighbours. The score of a candidate is its number of
/// inliers plus its similarity (0..1); it is accepted with at least inliers_min inliers and
/// 40 % of the guided matches. Bit-identical for any number of threads. O(keyframes^2)
/// comparisons of about 1 us; feature matching dominates up to ten thousand keyframes.
DetectedLoops detect_loops(const TrackingResult& tracked,
                           const Camera& camera,
                           const LoopOptions& options,
                           const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace loopbench::rgbd
