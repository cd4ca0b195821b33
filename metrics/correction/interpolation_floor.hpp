/// The error that remains between keyframes if every keyframe were exact.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

struct InterpolationFloorOptions {
  double max_gap = 0.1;
};

template <class Visit>
void fields(InterpolationFloorOptions& o, Visit visit) {
  visit("max_gap", o.max_gap, "largest reference gap a keyframe may lie in [s]", Above{0.0});
}

/// The reference itself is taken at the keyframes' stamps, joined again, and judged at each of its
/// own stamps in between: polyline 3d [m] by straight lines, natural_cubic 3d [m] by the natural
/// cubic spline in time, slerp 3d [deg] by great arcs. No method enters but its keyframe stamps, so
/// this is the same in every row of a table; in files every pose is a keyframe. Keyframes outside
/// the reference or in a gap of it are not exact: they end one stretch and begin the next.
/// Throws Undefined when no reference pose lies between two keyframes. O(n + m).
std::vector<Score> interpolation_floor(const Evaluation& evaluation,
                                       const InterpolationFloorOptions& options);

}  // namespace loopbench
