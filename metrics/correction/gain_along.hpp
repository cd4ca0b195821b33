/// What a method gained on the raw keyframes: by axis, and by part of the way.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

struct GainAlongOptions {};

template <class Visit>
void fields(GainAlongOptions&, Visit) {}

/// Before: the problem's keyframes joined by straight lines, judged at the same times under the
/// same protocol (aligned on their own). After: the estimate. All in %, positive is better.
///   translation x, y, z, 3d   100 (1 - after / before) of |position error|, by the one statistic
///                             that the protocol quotes; its count is the number of poses
///   angle 3d                  the same of the angle between the attitudes
///   first_third, middle_third, last_third 3d   over thirds of the reference's path
///   improved, worsened        share of poses whose 3-D error fell, rose
/// (The derived `gain` compares `ate` with a baseline method instead; this one needs no baseline.)
/// A gain on an error of exactly zero is undefined, and is declared so. Throws Undefined without a
/// problem, std::runtime_error when the raw keyframes cannot be judged. O(n log n).
std::vector<Score> gain_along(const Evaluation& evaluation, const GainAlongOptions& options);

}  // namespace loopbench
