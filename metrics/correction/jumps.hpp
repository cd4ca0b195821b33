/// Does the curve tear, kink or jerk where two pieces meet?
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

struct JumpsOptions {
  double reach = 0.1;
};

template <class Visit>
void fields(JumpsOptions& o, Visit visit) {
  visit("reach", o.reach, "part of an interval looked at on each side [-]", Between{1e-4, 0.5});
}

/// At every keyframe but the ends, right limit minus left limit of the curve, in the reference's
/// unit of length (scaled by the alignment): position [m], velocity [m/s], acceleration
/// [m/s^2]. A polyline has velocity jumps, a cubic spline none.
///
/// Each limit comes from the cubic through four points at 1/4, 2/4, 3/4 and 4/4 of `reach` times
/// the interval on its side, extrapolated to the keyframe: exact for pieces up to cubic, off by
/// O(h^4), O(h^3), O(h^2) otherwise (h = reach * interval). Rounding of positions of size p costs
/// about p 1e-16 {15, 130/h, 640/h^2}: for p = 10 m, h = 0.05 s that is 1e-14, 3e-12, 3e-10.
/// Pieces that meet between keyframes are not seen: a curve does not tell its joints. Throws
/// Undefined without a curve or for fewer than three keyframes, std::runtime_error where stamps are
/// too coarse for four different times. O(keyframes).
std::vector<Score> jumps(const Evaluation& evaluation, const JumpsOptions& options);

}  // namespace loopbench
