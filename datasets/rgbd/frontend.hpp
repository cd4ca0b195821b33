/// From images to a problem: features, tracking, keyframes, loops.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "datasets/core/sequence.hpp"
#include "datasets/rgbd/dense/refine_by_depth.hpp"
#include "datasets/rgbd/loops/detector.hpp"
#include "datasets/rgbd/rgbd_source.hpp"
#include "datasets/rgbd/tracking/tracker.hpp"

namespace loopbench {

struct FrontendOptions {
  FeatureOptions features;
  TrackOptions track;
  LoopOptions loops;
  RefineOptions refine;
  double skipped_max = 0.5;
};

template <class Visit>
void fields(FrontendOptions& o, Visit visit) {
  fields(o.features, visit);
  fields(o.track, visit);
  fields(o.loops, visit);
  fields(o.refine, visit);
  visit("skipped_max", o.skipped_max, "share of frames that may be unreadable [-]", Between{0, 1});
}

/// What a slow load may use of its surroundings.
struct FrontendHooks {
  /// Called as it goes, from one thread: stage, done, of how many.
  std::function<void(const std::string&, std::size_t, std::size_t)> progress = {};
  /// Where stages keep what they have worked out (see StageCache); empty: nowhere.
  std::filesystem::path cache = {};
};

/// Images are read and features found on all cores, a few frames ahead of the tracker; no more
/// images than that are in memory. Kept are the features of keyframes (60 kB each) and poses.
/// Frames that cannot be read are skipped and said in the provenance's notes; more than
/// skipped_max of them, or fewer than two tracked keyframes, throw InputError. With refine.depth,
/// odometry and closures are measured again by refine_by_depth(), and keyframes and frames follow.
/// Noted too: focal lengths that the images contradict (check_focal), and information divided by
/// information_excess() or remeasured_excess(), the larger, where that is above 1.
Sequence run_frontend(const RgbdSource& source,
                      const std::string& name,
                      const FrontendOptions& options,
                      const FrontendHooks& hooks);

}  // namespace loopbench
