/// Closures whose stated covariance contradicts their residuals.
#pragma once

#include <vector>

#include "metrics/doctor/closure_chain.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// Compares each pair of neighbouring closures with its covariance (`errors`, one for each pair). A
/// finding if pairs agree ten thousand times better than most: a squared error over its variance
/// below 1e-4 of the median and 1e-5, which has a probability below 1e-7 in three dimensions.
/// Copies of a closure do not count. Too small a covariance of single closures has no effect on
/// these pairs, because the other closure explains their difference. O(pairs).
std::vector<InputFinding> check_edges(const std::vector<Edge>& closures,
                                      const std::vector<Neighbours>& neighbours,
                                      const std::vector<SquaredError>& errors);

}  // namespace loopbench::metrics
