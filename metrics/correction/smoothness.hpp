/// Smoothness of the estimated curve: jerk, jumps at the keyframes, and path length.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

struct JerkOptions {
  double rate = 10.0;
  double max_gap = 0.5;
};

template <class Visit>
void fields(JerkOptions& o, Visit visit) {
  visit("rate", o.rate, "sampling rate of both curves [1/s]", GreaterThan{0.0});
  visit(
      "max_gap", o.max_gap, "reference gap beyond which samples are skipped [s]", GreaterThan{0.0});
}

/// Samples curve and reference (linear between its poses) at the same times with `rate`. Jerk is 6
/// times the third divided difference: estimate and reference 3d [m/s^3], and the ratio of their
/// rmse [1]. Values for different rates are not comparable: noise of size s gives about 4.5 s
/// rate^3, and nothing is filtered before sampling. Intervals across a reference gap are skipped.
/// The estimate is scaled by the alignment. Throws Undefined without a curve, or with fewer than
/// four common samples. O(n + span * rate).
std::vector<Score> jerk(const Evaluation& evaluation, const JerkOptions& options);

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

/// Sum of the distances between evaluated poses, after alignment: estimate [m], reference [m],
/// ratio [1] = estimate over reference. Both are sampled at the same pairs, so a denser list has no
/// effect; jitter still increases the length. sim3 alignment removes most of the deviation from 1.
/// Throws Undefined if the reference does not move. O(n).
std::vector<Score> path_length_ratio(const Evaluation& evaluation);

}  // namespace loopbench::metrics
