/// Checks of the edges of a pose graph: direction and plausibility of closures, information.
#pragma once

#include <vector>

#include "datasets/core/problem.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// Compares closures with the odometry, without a reference:
/// - direction: neighbouring closures connect the same two sections of the chain, so that the
///   drift between them cancels; if the inverses are much more consistent, closures are inverted.
///   Closures without neighbours are compared with the odometry, see inversion_log_ratio();
/// - gaps: see check_gaps();
/// - information: see check_information() and check_edges().
/// Empty if the odometry is no chain. O((closures + keyframes) log).
std::vector<InputFinding> check_closures(const Problem& problem);

}  // namespace loopbench::metrics
