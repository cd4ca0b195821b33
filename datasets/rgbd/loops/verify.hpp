/// Geometric verification of a loop candidate.
#pragma once

#include "datasets/rgbd/tracking/tracker.hpp"

namespace loopbench::rgbd {

struct Verified {
  Edge edge;
  std::size_t inliers = 0;
  double share = 0.0;  ///< share of inliers among guided matches [-]
};

/// Estimates the pose of keyframe `to` in the frame of keyframe `from`, from the points of `from`
/// and then also of its neighbours, which are transformed by odometry. Zero inliers if no pose is
/// found. O(features^2).
Verified verify(const std::vector<Keyframe>& keyframes,
                std::size_t from,
                std::size_t to,
                const Camera& camera,
                const TrackOptions& options);

}  // namespace loopbench::rgbd
