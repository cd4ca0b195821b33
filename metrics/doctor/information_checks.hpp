/// Checks of the stated information of a pose graph.
#pragma once

#include <vector>

#include "metrics/doctor/closure_chain.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// Compares the gaps of all loops (`errors`: closure_error() of each) with the covariance of
/// odometry and closures. Medians of translation and rotation far from 1, but near 1 after exchange
/// of the blocks: wrong order. Far from 1 otherwise: wrong scale, of the odometry only if pairs of
/// neighbouring closures (`neighbours`: their errors) agree with their covariance. Only these pairs
/// far from it: wrong scale of the closures. The factor of a wrong scale is fitted to every other
/// gap, and has to bring the remaining ones closer to 1. O(closures).
std::vector<InputFinding> check_information(const std::vector<Edge>& closures,
                                            const std::vector<SquaredError>& errors,
                                            const std::vector<SquaredError>& neighbours,
                                            const Chain& chain);

}  // namespace loopbench::metrics
