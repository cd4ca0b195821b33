/// Checks of the content of files: exchanged, without rotations, other angles, jumps.
#pragma once

#include <optional>
#include <string>

#include "datasets/core/trajectory.hpp"
#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// Only the estimate's name contains a word like "groundtruth", or the estimate has at least twice
/// the rate of the reference and covers it, both rotate, and the names do not contradict. O(1).
std::optional<InputFinding> check_swapped(const Trajectory& reference,
                                          const Trajectory& estimate,
                                          const std::string& reference_name,
                                          const std::string& estimate_name);

/// The rotation of one trajectory is constant while it moves by more than 0.2 m and the other one
/// rotates by more than 0.1 rad. O(n).
std::optional<InputFinding> check_constant_rotation(const Trajectory& reference,
                                                    const Trajectory& estimate);

/// The estimate's rotations over short distances are 57.3 times those of the reference, or a 57th.
/// O(n).
std::optional<InputFinding> check_angle_unit(const CommonPoses& poses);

/// Removes up to five jumps of the estimate's positions from `poses`; a finding if that
/// reduces the position error. Otherwise, `poses` are unchanged. O(n).
std::optional<InputFinding> remove_jumps(CommonPoses& poses);

}  // namespace loopbench::metrics
