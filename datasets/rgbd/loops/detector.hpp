/// Loop detection from images: retrieval by bag of words and geometric verification.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "datasets/core/sequence.hpp"
#include "datasets/rgbd/tracking/tracker.hpp"

namespace loopbench::rgbd {

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
  visit("loops.enabled", o.enabled, "detection of loop closures");
  visit("loops.min_gap",
        o.min_gap,
        "minimum time between the keyframes of a loop closure [s]",
        GreaterThan{0});
  visit("loops.candidates",
        o.candidates,
        "maximum number of candidates verified per keyframe",
        Between{1, 100});
  visit("loops.similarity_min",
        o.similarity_min,
        "minimum bag-of-words similarity, relative to that of consecutive keyframes [-]",
        Between{0, 1});
  visit("loops.consistency",
        o.consistency,
        "number of previous keyframes that must retrieve the same place",
        Between{0, 20});
  visit("loops.inliers_min",
        o.inliers_min,
        "minimum number of inliers of an accepted closure",
        Between{6});
  visit("loops.share_min",
        o.share_min,
        "minimum share of inliers among guided matches of an accepted closure [-]",
        Between{0, 1});
  visit("loops.branches", o.branches, "branching factor of the vocabulary tree", Between{2, 100});
  visit("loops.levels", o.levels, "number of levels of the vocabulary tree", Between{1, 8});
  visit("loops.training",
        o.training,
        "maximum number of descriptors to train the vocabulary",
        Between{100});
  visit("loops.vocabulary_seed", o.seed, "random seed of the vocabulary training", Between{0});
}

struct DetectedLoops {
  std::vector<Edge> closures = {};             ///< sorted by (to, from)
  std::vector<LoopCandidate> candidates = {};  ///< best candidate of each keyframe, sorted by `to`
  double seconds = 0.0;                        ///< CPU time of all threads [s]
};

/// Detects loop closures between keyframes. A vocabulary is trained on the descriptors of the
/// keyframes. For each keyframe the most similar keyframes at least min_gap older are retrieved; a
/// candidate is consistent if the previous `consistency` keyframes retrieved it or one of its
/// neighbours. Candidates are verified by feature matching, RANSAC against the points of the older
/// keyframe, and refinement with the points of its neighbours. The score of a candidate is its
/// number of inliers plus its similarity (0..1); it is accepted with at least inliers_min inliers
/// and share_min of the guided matches. Bit-identical for any number of threads. O(keyframes^2)
/// comparisons of about 1 us; feature matching dominates up to ten thousand keyframes.
DetectedLoops detect_loops(const TrackingResult& tracked,
                           const Camera& camera,
                           const TrackOptions& track,
                           const LoopOptions& options,
                           const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace loopbench::rgbd
