#include "datasets/rgbd/loops/detector.hpp"

#include "datasets/rgbd/cpu_clock.hpp"
#include "datasets/rgbd/loops/retrieval.hpp"
#include "datasets/rgbd/loops/verify.hpp"
#include "datasets/rgbd/ordered_pipeline.hpp"

namespace loopbench::rgbd {
namespace {

struct Best {
  Verified verified;
  double score = -1.0;
  double seconds = 0.0;
};

}  // namespace

DetectedLoops detect_loops(const TrackingResult& tracked,
                           const Camera& camera,
                           const TrackOptions& track,
                           const LoopOptions& options,
                           const std::function<void(std::size_t, std::size_t)>& progress) {
  DetectedLoops out;
  if (!options.enabled) return out;
  const std::vector<Keyframe>& keyframes = tracked.keyframes;
  const double begin = cpu_seconds();
  const auto candidates = retrieve(keyframes, options);
  out.seconds = cpu_seconds() - begin;
  const auto best_of = [&](std::size_t k) {
    const double start = cpu_seconds();
    Best best;
    for (const RetrievedKeyframe& candidate : candidates[k]) {
      Verified verified = verify(keyframes, candidate.keyframe, k, camera, track);
      const double score =
          static_cast<double>(verified.inliers) + std::min(1.0, candidate.similarity);
      if (score > best.score) best = {std::move(verified), score, 0.0};
    }
    best.seconds = cpu_seconds() - start;
    return best;
  };
  ordered_pipeline<Best>(keyframes.size(),
                         hardware_threads(),
                         4 * hardware_threads(),
                         best_of,
                         [&](std::size_t k, const Best& best) {
                           progress(k + 1, keyframes.size());
                           out.seconds += best.seconds;
                           if (best.score < 0.0) return;
                           const Verified& loop = best.verified;
                           const bool accepted =
                               loop.inliers >= static_cast<std::size_t>(options.inliers_min) &&
                               loop.share >= options.share_min;
                           out.candidates.push_back({loop.edge.from, k, best.score, accepted});
                           if (accepted) out.closures.push_back(loop.edge);
                         });
  return out;
}

}  // namespace loopbench::rgbd
