/// Checks of the edges of a pose graph: direction and plausibility of closures, information.
#pragma once

#include <vector>

#include "datasets/core/problem.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// Compares closures with the odometry, without a reference:
/// - conventions of odometry and closures: see find_odometry_repair() and find_closure_repair();
/// - gaps: see check_gaps();
/// - information: see check_information() and check_edges(), without the closures found before, and
///   only if these are less than a fifth.
/// Empty if the odometry is no chain. O((closures + keyframes) log).
std::vector<InputFinding> check_closures(const Problem& problem);

}  // namespace loopbench::metrics
