#pragma once

#include "datasets/rgbd/features/matching.hpp"
#include "datasets/rgbd/tracking/camera_pose.hpp"

namespace loopbench::rgbd {

/// Converts matches to observations of map points in an image, in the same order. O(matches).
std::vector<Observation> observations(const std::vector<MapPoint>& points,
                                      const Features& features,
                                      const std::vector<Match>& matches);

}  // namespace loopbench::rgbd
