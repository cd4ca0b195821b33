/// Position and rotation error along and about each axis of the reference's world frame.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

struct AxisErrorOptions {
  bool rotation = false;
};

template <class Visit>
void fields(AxisErrorOptions& o, Visit visit) {
  visit("rotation", o.rotation, "also compute roll, pitch and yaw errors");
}

/// translation x, y, z [m]: |p_estimate - p_reference| along the axis. The squares of the three
/// rmse values add up to the squared 3-D rmse. The values depend on the orientation of the world
/// frame, and min depends mostly on the sample count. With `rotation`, the scores of ape's rpy
/// follow. O(n).
std::vector<Score> axis_error(const Evaluation& evaluation, const AxisErrorOptions& options);

}  // namespace loopbench::metrics
