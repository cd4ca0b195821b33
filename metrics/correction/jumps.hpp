/// Discontinuities of a curve and its derivatives at the keyframes.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

struct JumpsOptions {
  double reach = 0.1;
};

template <class Visit>
void fields(JumpsOptions& o, Visit visit) {
  visit("reach",
        o.reach,
        "fraction of the keyframe interval sampled on each side of a keyframe [-]",
        Between{1e-4, 0.5});
}

/// At every interior keyframe, right limit minus left limit of the curve, scaled by the alignment:
/// position [m], velocity [m/s], acceleration [m/s^2]. A polyline has velocity jumps, a cubic
/// spline has none.
///
/// Each limit is extrapolated from the cubic through four points at 1/4, 2/4, 3/4 and 4/4 of
/// `reach` times the interval on its side: exact for pieces up to cubic, otherwise with error
/// O(h^4), O(h^3), O(h^2), where h = reach * interval. Rounding of positions of size p adds about
/// p 1e-16 {15, 130/h, 640/h^2}: for p = 10 m, h = 0.05 s that is 1e-14, 3e-12, 3e-10. Knots
/// between keyframes are not evaluated, because a curve does not expose its knots. Throws Undefined
/// without a curve or for fewer than three keyframes, std::runtime_error if the stamps are too
/// coarse for four different times. O(keyframes).
std::vector<Score> jumps(const Evaluation& evaluation, const JumpsOptions& options);

}  // namespace loopbench::metrics
