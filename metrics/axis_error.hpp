/// Position error along each axis of the reference's world.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

struct AxisErrorOptions {};

template <class Visit>
void fields(AxisErrorOptions&, Visit) {}

/// translation x, y, z [m]: |p_estimate - p_reference| along the axis. Squares of the three rmse
/// add up to the 3-D one. These numbers depend on how the world is turned, and min is mostly an
/// artefact of the sample count. O(n).
std::vector<Score> axis_error(const Evaluation& evaluation, const AxisErrorOptions& options);

}  // namespace loopbench
