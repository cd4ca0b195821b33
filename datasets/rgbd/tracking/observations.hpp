#pragma once

#include "datasets/rgbd/features/matching.hpp"
#include "datasets/rgbd/tracking/camera_pose.hpp"

namespace loopbench {

/// What each match measures: a point known in the world, where `features` see it. One per match,
/// in their order. O(matches).
std::vector<Observation> observations(const std::vector<Seen>& points,
                                      const Features& features,
                                      const std::vector<Match>& matches);

}  // namespace loopbench
