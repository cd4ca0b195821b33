/// Closures that the odometry or other closures contradict.
#pragma once

#include <optional>
#include <vector>

#include "metrics/doctor/closure_chain.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

struct GapCheck {
  std::optional<InputFinding> finding;
  std::vector<std::size_t> closures;  ///< indices of the false ones
};

/// - The odometry along a loop ends further from the closure than 2 m, and than eight times the
///   drift per distance of the median loop (at most 35 % of the loop's length) or 50 times the
///   squared error over its variance of nine in ten loops.
/// - If there is none, and for at least ten closures: the same limit of the gap over the length of
///   the shortest path over odometry and other closures, which drifts less. The worst closure is
///   removed before the others are compared again.
/// `errors`: closure_error() of each closure. O((keyframes + closures) log).
GapCheck check_gaps(const Problem& problem,
                    const Chain& chain,
                    const std::vector<SquaredError>& errors);

}  // namespace loopbench::metrics
