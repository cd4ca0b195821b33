/// Steps and loops that features found, measured again with all of the depth images.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "datasets/core/fields.hpp"
#include "datasets/rgbd/rgbd_source.hpp"
#include "datasets/rgbd/tracking/tracker.hpp"

namespace loopbench {

struct RefineOptions {
  bool depth = true;
  std::int64_t window = 5;
  double overlap_min = 0.2;
};

template <class Visit>
void fields(RefineOptions& o, Visit visit) {
  visit("refine.depth", o.depth, "measure odometry and loops again, by surfaces in depth images");
  visit(
      "refine.window", o.window, "keyframes whose surfaces a new one is laid on", Between{1, 100});
  visit("refine.overlap_min",
        o.overlap_min,
        "share of a surface that must lie on others [-]",
        Between{0, 1});
}

/// Edges as they were where surfaces do not say better.
struct RefinedEdges {
  std::vector<Edge> odometry = {};
  std::vector<Edge> closures = {};
  std::size_t odometry_refined = 0;
  std::size_t closures_refined = 0;
  double seconds = 0.0;  ///< of all threads
};

/// Lays every keyframe's surface on those of the `window` keyframes before, by align_surface() with
/// the features' edge as prior; then every closure's on those of its older keyframe and that one's
/// two neighbours. An edge stays as it was when the surfaces overlap too little, when they would
/// move it by more than 0.15 m or 0.15 rad, when an image cannot be read, or, for odometry, when it
/// is a guess over lost tracking; after such a step the window begins anew. Depth is read again for
/// keyframes; kept are 77 kB each. Same bits on any number of threads.
/// O(keyframes * window * pixels).
RefinedEdges refine_by_depth(const RgbdSource& source,
                             const Tracked& tracked,
                             const std::vector<Edge>& closures,
                             const PoseOptions& pose,
                             double depth_max,
                             const RefineOptions& options,
                             const std::function<void(std::size_t, std::size_t)>& progress);

/// Chains the keyframes anew by `odometry`. Frames between two keyframes keep their places relative
/// to both, the nearer in time counting more. O(keyframes + frames).
void follow_odometry(Tracked& tracked, const std::vector<Edge>& odometry);

}  // namespace loopbench
