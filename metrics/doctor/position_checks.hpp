/// Checks of trajectories that are positions without rotation.
#pragma once

#include <string>

#include "metrics/doctor/diagnose.hpp"

namespace loopbench::metrics {

/// diagnosis() of positions: rotations are taken as constant, which is no finding here, and neither
/// is a reference of a lower rate than the estimate. O(n) and the cost of diagnosis().
Diagnosis diagnosis_of_positions(Trajectory reference,
                                 Trajectory estimate,
                                 const std::string& reference_name,
                                 const std::string& estimate_name,
                                 bool has_stamps);

}  // namespace loopbench::metrics
