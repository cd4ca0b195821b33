/// Lever arm and time offset of a reference that is a point: a prism or an antenna.
#pragma once

#include "metrics/checks/point_offset.hpp"
#include "metrics/metric.hpp"

namespace loopbench::metrics {

struct LeverArmOptions {
  double longest = 1.0;
};

template <class Visit>
void fields(LeverArmOptions& o, Visit visit) {
  visit("longest",
        o.longest,
        "longest interval of the estimate to interpolate across [s]",
        GreaterThan{0.0});
}

/// Descriptions, estimated with the alignment from the positions of the reference
/// (fit_point_offset()); nothing is applied. `position` x, y, z [m] of the point in the estimate's
/// body frame, `offset` [s] to add to the estimate's stamps, `half_width` of their 95 % intervals,
/// `correlation` of each pair (`t`: the offset); those that the motion does not determine are
/// undefined, with the reason. `ate` before and after [m], rmse. Scale is estimated if the
/// protocol's alignment has it. Throws Undefined if the estimate has no rotations. O(n).
std::vector<Score> lever_arm(const Evaluation& evaluation, const LeverArmOptions& options);

}  // namespace loopbench::metrics
