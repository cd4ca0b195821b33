/// All pose pairs with a given rotation angle between them.
#pragma once

#include "metrics/pairing/pair_search.hpp"

namespace loopbench::metrics {

/// Every i < j whose relative rotation angle is within `tolerance` of `angle` [rad], both limits
/// included, ordered by i, then j: evo's all-pairs rule for angles. The result can hold n^2 / 2
/// pairs. Otherwise O((n + pairs) log n) for steady rotation: intervals of the trajectory are
/// bounded by a middle orientation and the largest angle to it, and accepted or skipped as a whole.
/// O(n^2) if the orientation jumps from pose to pose.
std::vector<FromTo> angle_pairs(const Trajectory& trajectory, double angle, double tolerance);

}  // namespace loopbench::metrics
