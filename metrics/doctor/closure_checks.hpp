/// Checks of the edges of a pose graph: direction and plausibility of closures, information.
#pragma once

#include <vector>

#include "datasets/core/problem.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// Compares closures with the odometry, without a reference:
/// - direction: neighbouring closures connect the same two stretches of the chain, so that the
/// drift
///   between them cancels; if the inverses are much more consistent, closures are inverted;
/// - gap: the odometry along a loop ends further from the closure than 2 m and eight times the
/// drift
///   per distance of the median loop (at most 35 % of the loop's length);
/// - information: squared residuals of neighbouring closures, divided by their covariance,
/// separately
///   for translation and rotation: far from 1 in opposite directions and near 1 after exchange of
///   the blocks (order), or both far from 1 (scale).
/// O(closures + keyframes).
std::vector<InputFinding> check_closures(const Problem& problem);

}  // namespace loopbench::metrics
