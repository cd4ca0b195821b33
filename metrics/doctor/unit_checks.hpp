/// Checks of units and scale.
#pragma once

#include <optional>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

inline constexpr std::size_t kFewestUnitPoses = 8;  ///< fewer cannot be checked

/// Rotation angles that differ by a factor near 57.3 or 1 / 57.3. Small angles show degrees used as
/// radians, because larger ones wrap; larger ones show the reverse. O(poses).
std::optional<InputFinding> check_angle_unit(const CommonPoses& poses);

/// Units and scale: check_angle_unit(), ratios of distances near 1000 or 0.001 (or 100, 0.01), or a
/// scale that removes most of the error after rigid alignment. The stamps must agree. O(n + m).
std::vector<InputFinding> check_units(const Trajectory& reference, const Trajectory& estimate);

}  // namespace loopbench::metrics
