/// Checks of the stated information of a pose graph.
#pragma once

#include <vector>

#include "metrics/doctor/closure_chain.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// Compares the gaps of all loops with the covariance of odometry and closures, separately for
/// translation and rotation. Medians far from 1, but near 1 after exchange of the blocks
/// (`exchanged`: the chain read so): wrong order. Both far from 1: wrong scale. O(closures).
std::vector<InputFinding> check_information(const std::vector<Edge>& closures,
                                            const Chain& chain,
                                            const Chain& exchanged);

}  // namespace loopbench::metrics
