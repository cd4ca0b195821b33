/// Loop closures from images: who looks alike, and whether the geometry agrees.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "datasets/core/sequence.hpp"
#include "datasets/rgbd/tracking/tracker.hpp"

namespace loopbench {

struct LoopOptions {
  bool enabled = true;
  double min_gap = 5.0;  ///< [s]
  std::int64_t candidates = 3;
  double similarity_min = 0.15;
  std::int64_t consistency = 1;
  std::int64_t inliers_min = 40;
  double share_min = 0.4;
  std::int64_t branches = 10;
  std::int64_t levels = 4;
  std::int64_t training = 20000;
  std::int64_t seed = 1;
};

template <class Visit>
void fields(LoopOptions& o, Visit visit) {
  visit("loops.enabled", o.enabled, "look for loop closures");
  visit("loops.min_gap", o.min_gap, "shortest loop [s]", Above{0});
  visit("loops.candidates", o.candidates, "places verified for a keyframe", Between{1, 100});
  visit("loops.similarity_min",
        o.similarity_min,
        "of bags of words, over that of neighbouring keyframes [-]",
        Between{0, 1});
  visit("loops.consistency",
        o.consistency,
        "earlier keyframes that must have found the same place",
        Between{0, 20});
  visit("loops.inliers_min", o.inliers_min, "points that agree on one pose", Between{6});
  visit("loops.share_min", o.share_min, "of points matched near that agree [-]", Between{0, 1});
  visit("loops.branches", o.branches, "of the vocabulary tree", Between{2, 100});
  visit("loops.levels", o.levels, "of the vocabulary tree", Between{1, 8});
  visit("loops.training", o.training, "descriptors it is trained on, at most", Between{100});
  visit("loops.vocabulary_seed", o.seed, "of its training", Between{0});
}

struct DetectedLoops {
  std::vector<Edge> closures = {};             ///< sorted by (to, from)
  std::vector<LoopCandidate> candidates = {};  ///< best of each keyframe, sorted by `to`
  double seconds = 0.0;                        ///< of all threads
};

/// A vocabulary is trained on the keyframes' own descriptors. Every keyframe asks for the most
/// alike among those at least min_gap older; a place stands when the `consistency` keyframes before
/// found it, or a neighbour of it, too. What stands is matched, posed by RANSAC against the older
/// keyframe's points, and refined against the points of its neighbours as well. The score of a
/// candidate is the number of points that agree, plus its similarity (0..1); it is accepted with
/// inliers_min of them. Threads do not change the bits. O(keyframes^2) bags are compared, at a
/// microsecond each; features dominate up to ten thousand keyframes.
DetectedLoops detect_loops(const Tracked& tracked,
                           const Camera& camera,
                           const TrackOptions& track,
                           const LoopOptions& options,
                           const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace loopbench
