/// Correction of the edges of a pose graph.
#pragma once

#include <vector>

#include "datasets/core/problem.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// Applies findings of check_closures(): inverts the closures, removes those that contradict
/// others, exchanges the blocks of the information or multiplies it. Other findings are ignored.
/// O(edges).
void repair(Problem& problem, const std::vector<InputFinding>& findings);

}  // namespace loopbench::metrics
