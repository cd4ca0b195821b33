/// Check of a correction: closures that move nothing.
#pragma once

#include <optional>

#include "datasets/core/problem.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// A finding if the closures differ from the odometry, but no keyframe has moved by a hundredth of
/// their median difference. `corrected`: the keyframes after the correction, as many as before.
/// nullopt without closures or if their median difference is below 1 mm and 0.01 deg.
/// O(keyframes + closures).
std::optional<InputFinding> check_movement(const Problem& problem, const Trajectory& corrected);

}  // namespace loopbench::metrics
