/// RGB-D front end: from images to a problem by features, tracking, keyframes and loop detection.
#pragma once

#include <functional>
#include <string>

#include "datasets/core/sequence.hpp"
#include "datasets/images/dense/refine_by_depth.hpp"
#include "datasets/images/frames/rgbd_source.hpp"
#include "datasets/images/loops/detector.hpp"
#include "datasets/images/tracking/tracker.hpp"

namespace loopbench::rgbd {

struct FrontendOptions {
  FeatureOptions features;
  TrackOptions track;
  LoopOptions loops;
  bool refine_depth = true;
  double skipped_max = 0.5;
};

template <class Visit>
void fields(FrontendOptions& o, Visit visit) {
  fields(o.features, visit);
  fields(o.track, visit);
  fields(o.loops, visit);
  visit("refine.depth",
        o.refine_depth,
        "refinement of odometry and loop closures by alignment of depth images");
  visit("skipped_max",
        o.skipped_max,
        "maximum share of frames that cannot be read [-]",
        Between{0, 1});
}

/// Called from one thread with stage, completed items and total number of items, unless empty.
using FrontendProgress = std::function<void(const std::string&, std::size_t, std::size_t)>;

/// Runs the front end on all frames of `source`. Images are read and features detected on all
/// cores, a few frames ahead of the tracker; only these images are in memory, together with the
/// features of keyframes (60 kB each) and all poses. With refine.depth, odometry and closures are
/// refined by refine_by_depth(), and keyframes and frames are updated. If information_excess() of
/// loops or of repeated measurements is above 1, all information matrices are divided by the larger
/// one. Provenance notes report skipped frames, tracking losses and the divisor of the information.
/// Throws InputError if more than skipped_max of the frames cannot be read or if fewer than two
/// keyframes are tracked.
Sequence run_frontend(const RgbdSource& source,
                      const std::string& name,
                      const FrontendOptions& options,
                      const FrontendProgress& progress);

}  // namespace loopbench::rgbd
