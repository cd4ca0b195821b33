/// Ratio of the path lengths of estimate and reference.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

/// Sum of the distances between evaluated poses, after alignment: estimate [m], reference [m],
/// ratio [1] = estimate over reference. Both are sampled at the same pairs, so a denser list has no
/// effect; jitter still increases the length. sim3 alignment removes most of the deviation from 1.
/// Throws Undefined if the reference does not move. O(n).
std::vector<Score> path_length_ratio(const Evaluation& evaluation);

}  // namespace loopbench::metrics
