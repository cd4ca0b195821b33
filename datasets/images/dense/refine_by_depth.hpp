/// Refinement of odometry and loop closures by dense alignment of depth images.
#pragma once

#include <functional>
#include <vector>

#include "datasets/images/frames/rgbd_source.hpp"
#include "datasets/images/tracking/tracker.hpp"

namespace loopbench::rgbd {

/// Odometry and closures after refinement; edges that could not be refined are unchanged.
struct RefinedEdges {
  std::vector<Edge> odometry = {};
  std::vector<Edge> closures = {};
  std::size_t odometry_refined = 0;
  std::size_t closures_refined = 0;
};

/// Aligns the surface of each keyframe with those of the previous five keyframes by
/// align_surface(), with the feature-based edge as prior; then that of the newer keyframe of each
/// closure with those of the older keyframe and its two neighbours. An edge remains unchanged if
/// the surfaces overlap too little, if the correction exceeds 0.15 m or 0.15 rad, if an image
/// cannot be read, or if an odometry edge was not measured (tracking loss). After an unchanged
/// odometry edge the window is restarted. Depth images of keyframes are read again and stored at 77
/// kB each. Bit-identical for any number of threads. O(keyframes * pixels).
RefinedEdges refine_by_depth(const RgbdSource& source,
                             const TrackingResult& tracked,
                             const std::vector<Edge>& closures,
                             double depth_max,
                             const std::function<void(std::size_t, std::size_t)>& progress);

/// Recomputes keyframe poses from `odometry`. Frames between two keyframes are moved with both,
/// interpolated in time. O(keyframes + frames).
void update_poses(TrackingResult& tracked, const std::vector<Edge>& odometry);

}  // namespace loopbench::rgbd
