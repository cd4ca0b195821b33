/// Jumps of the current pose at closures.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

/// Distance [m], scaled by the alignment, and rotation angle [deg] between the pose of the current
/// keyframe before and after each update with closures. `rmse` is the root mean square over these
/// updates, `max` the largest jump. Needs no reference. Throws Undefined if the method was not
/// replayed or no closure arrived. O(updates).
std::vector<Score> closure_jumps(const Evaluation& evaluation, const NoOptions& options = {});

}  // namespace loopbench::metrics
