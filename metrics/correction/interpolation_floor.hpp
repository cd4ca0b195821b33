/// Interpolation error between keyframes if every keyframe were exact.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

struct InterpolationFloorOptions {
  double max_gap = 0.1;
};

template <class Visit>
void fields(InterpolationFloorOptions& o, Visit visit) {
  visit("max_gap", o.max_gap, "largest reference gap around a keyframe [s]", GreaterThan{0.0});
}

/// Samples the reference at the keyframe stamps, interpolates, and compares with the reference at
/// each of its stamps in between: polyline 3d [m] (linear), natural_cubic 3d [m] (natural cubic
/// spline in time), slerp 3d [deg]. Depends only on the keyframe stamps of a method, so the value
/// is the same in every row of a table. In files every pose is a keyframe. Keyframes outside the
/// reference or in a reference gap are not exact; the interpolation is split there. Throws
/// Undefined if no reference pose lies between two keyframes. O(n + m).
std::vector<Score> interpolation_floor(const Evaluation& evaluation,
                                       const InterpolationFloorOptions& options);

}  // namespace loopbench::metrics
