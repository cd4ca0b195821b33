/// How much past poses still move, by their age.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

/// For each class of age (kAges in replay.hpp; the axis is its lower limit): root mean square over
/// its keyframes of the distance [m], scaled by the alignment, and of the rotation angle [deg] that
/// an update with closures moves them. The statistics are over the updates that had such keyframes;
/// a class without any has no score. Needs no reference. Throws Undefined if the method was not
/// replayed or no closure arrived. O(updates).
std::vector<Score> settling(const Evaluation& evaluation, const NoOptions& options = {});

}  // namespace loopbench::metrics
