/// Checks of the edges of a pose graph: direction and plausibility of closures, information.
#pragma once

#include <vector>

#include "datasets/core/problem.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// Compares closures with the odometry, without a reference:
/// - direction: neighbouring closures connect the same two stretches of the chain, so that the
/// drift
///   between them cancels; if the inverses are much more consistent, closures are inverted.
///   Closures without neighbours are compared with the odometry, by the ratio of likelihoods;
/// - gap: the odometry along a loop ends further from the closure than 2 m, and than eight times
/// the
///   drift per distance of the median loop (at most 35 % of the loop's length) or 50 times the
///   squared error over its variance of nine in ten loops;
/// - information: see check_information().
/// Empty if the odometry is no chain. O(closures + keyframes).
std::vector<InputFinding> check_closures(const Problem& problem);

}  // namespace loopbench::metrics
