/// Whether two keyframes see the same points, and from where.
#pragma once

#include "datasets/rgbd/tracking/tracker.hpp"

namespace loopbench {

struct Verified {
  Edge edge;
  std::size_t inliers = 0;
  double share = 0.0;  ///< of the points matched near that agree
};

/// Pose of keyframe `to` from the points of keyframe `from`, then of from's neighbours too, which
/// hang on it by odometry. No inliers when no pose is found. O(features^2).
Verified verify(const std::vector<Keyframe>& keyframes,
                std::size_t from,
                std::size_t to,
                const Camera& camera,
                const TrackOptions& options);

}  // namespace loopbench
