/// Detects exchanged reference and estimate.
#pragma once

#include <optional>
#include <string>

#include "datasets/core/trajectory.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// A finding if the names say so (only the estimate's contains "groundtruth", "truth", "gt" or
/// "vicon" as a word), or if the estimate has at least twice the rate of the reference and covers
/// it in time, and the names do not contradict. O(1).
std::optional<InputFinding> check_swapped(const Trajectory& reference,
                                          const Trajectory& estimate,
                                          const std::string& reference_name,
                                          const std::string& estimate_name);

}  // namespace loopbench::metrics
