/// Position and attitude error along and about each axis of the reference's world.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

struct AxisErrorOptions {
  bool rotation = false;
};

template <class Visit>
void fields(AxisErrorOptions& o, Visit visit) {
  visit("rotation", o.rotation, "also roll, pitch and yaw");
}

/// translation x, y, z [m]: |p_estimate - p_reference| along the axis. Squares of the three rmse
/// add up to the 3-D one. These numbers depend on how the world is turned, and min is mostly an
/// artefact of the sample count. With `rotation`, ape's rpy follows. O(n).
std::vector<Score> axis_error(const Evaluation& evaluation, const AxisErrorOptions& options);

}  // namespace loopbench
