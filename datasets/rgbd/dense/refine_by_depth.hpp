/// Refinement of odometry and loop closures by dense alignment of depth images.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "datasets/core/fields.hpp"
#include "datasets/rgbd/rgbd_source.hpp"
#include "datasets/rgbd/tracking/tracker.hpp"

namespace loopbench::rgbd {

struct RefineOptions {
  bool depth = true;
  std::int64_t window = 5;
  double overlap_min = 0.2;
};

template <class Visit>
void fields(RefineOptions& o, Visit visit) {
  visit("refine.depth",
        o.depth,
        "refinement of odometry and loop closures by alignment of depth images");
  visit("refine.window",
        o.window,
        "number of previous keyframes that a new keyframe is aligned with",
        Between{1, 100});
  visit("refine.overlap_min",
        o.overlap_min,
        "minimum share of a surface that overlaps the previous keyframes [-]",
        Between{0, 1});
}

/// Odometry and closures after refinement; edges that could not be refined are unchanged.
struct RefinedEdges {
  std::vector<Edge> odometry = {};
  std::vector<Edge> closures = {};
  std::size_t odometry_refined = 0;
  std::size_t closures_refined = 0;
};

/// Aligns the surface of each keyframe with those of the previous `window` keyframes by
/// align_surface(), with the feature-based edge as prior; then that of the newer keyframe of each
/// closure with those of the older keyframe and its two neighbours. An edge remains unchanged if
/// the surfaces overlap too little, if the correction exceeds 0.15 m or 0.15 rad, if an image
/// cannot be read, or if an odometry edge was not measured (tracking loss). After an unchanged
/// odometry edge the window is restarted. Depth images of keyframes are read again and stored at 77
/// kB each. Bit-identical for any number of threads. O(keyframes * window * pixels).
RefinedEdges refine_by_depth(const RgbdSource& source,
                             const TrackingResult& tracked,
                             const std::vector<Edge>& closures,
                             const PoseOptions& pose,
                             double depth_max,
                             const RefineOptions& options,
                             const std::function<void(std::size_t, std::size_t)>& progress);

/// Recomputes keyframe poses from `odometry`. Frames between two keyframes are moved with both,
/// interpolated in time. O(keyframes + frames).
void update_poses(TrackingResult& tracked, const std::vector<Edge>& odometry);

}  // namespace loopbench::rgbd
