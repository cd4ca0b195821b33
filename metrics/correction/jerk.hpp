/// Jerk of the estimated curve and of the reference.
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

}  // namespace loopbench::metrics
