/// How rough is the curve, beside how rough the reference is?
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

struct JerkOptions {
  double rate = 10.0;
  double max_gap = 0.5;
};

template <class Visit>
void fields(JerkOptions& o, Visit visit) {
  visit("rate", o.rate, "how often both are sampled [1/s]", Above{0.0});
  visit("max_gap", o.max_gap, "reference gap beyond which nothing is compared [s]", Above{0.0});
}

/// Curve and reference (straight lines between its poses) asked at the same times, `rate` a
/// second; jerk = third divided difference times 6: estimate and reference 3d [m/s^3],
/// their ratio of rmse [1]. Numbers of different rates do not compare: noise of size s reads about
/// 4.5 s rate^3, and nothing is filtered before sampling. Stretches over a reference gap are left
/// out. Estimate in the reference's unit of length. Throws Undefined without a curve, or
/// with fewer than four samples in common. O(n + span * rate).
std::vector<Score> jerk(const Evaluation& evaluation, const JerkOptions& options);

}  // namespace loopbench
