/// All pairs of poses turned against each other by a given angle.
#pragma once

#include "metrics/pairing/pair_search.hpp"

namespace loopbench {

/// Every i < j whose direct angle is within `tolerance` of `angle` [rad], both ends included, by i,
/// then j: evo's all-pairs rule for angles. The result itself can hold n^2 / 2 pairs. Otherwise
/// O((n + pairs) log n) on motions that turn steadily: stretches of the trajectory are bounded by a
/// middle attitude and a largest angle to it, and taken or passed over whole. Attitudes that jump
/// from pose to pose cannot be bounded so, and cost O(n^2).
std::vector<FromTo> angle_pairs(const Trajectory& trajectory, double angle, double tolerance);

}  // namespace loopbench
