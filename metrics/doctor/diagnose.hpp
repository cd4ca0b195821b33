/// All checks of a pair of trajectories, in an order in which one mistake does not hide another.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// Names are used by check_swapped() only. Conventions are checked first, because they affect the
/// speeds; then the time offset; then units and scale at that offset. `has_stamps`: false if the
/// stamps of either are generated, so that there is no time offset. O(1e6).
std::vector<InputFinding> diagnose(const Trajectory& reference,
                                   const Trajectory& estimate,
                                   const std::string& reference_name,
                                   const std::string& estimate_name,
                                   bool has_stamps = true);

}  // namespace loopbench::metrics
