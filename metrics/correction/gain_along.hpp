/// Improvement of a method over the raw keyframes, by axis and by third of the path.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

struct GainAlongOptions {};

template <class Visit>
void fields(GainAlongOptions&, Visit) {}

/// Before: the problem's keyframes, interpolated linearly, evaluated at the same times with the
/// same protocol (aligned separately). After: the estimate. All in %, positive is better.
///   translation x, y, z, 3d   100 (1 - after / before) of |position error|, with the statistic
///                             of the protocol; count is the number of poses
///   angle 3d                  the same for the angle between the orientations
///   first_third, middle_third, last_third 3d   over thirds of the reference's path
///   improved, worsened        share of poses whose 3-D error decreased, increased
/// (The derived metric `gain` compares `ate` with a baseline method; this metric needs no
/// baseline.) A gain over an error of exactly zero is undefined and reported as such. Throws
/// Undefined without a problem, std::runtime_error if the raw keyframes cannot be evaluated.
/// O(n log n).
std::vector<Score> gain_along(const Evaluation& evaluation, const GainAlongOptions& options);

}  // namespace loopbench::metrics
