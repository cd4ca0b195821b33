/// Checks of what the other checks need: common times, motion of both kinds.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// A finding if the stamps of one file fit those of the other only after division by 10^3, 10^6 or
/// 10^9. O(1).
std::optional<InputFinding> check_stamp_unit(const Trajectory& reference,
                                             const Trajectory& estimate);

/// A finding if the time ranges do not overlap. O(1).
std::optional<InputFinding> check_overlap(const Trajectory& reference, const Trajectory& estimate);

/// A finding if the rotation of one trajectory is constant while it moves by more than 0.5 m and
/// the other one rotates by more than 0.3 rad. O(n).
std::optional<InputFinding> check_constant_rotation(const Trajectory& reference,
                                                    const Trajectory& estimate);

struct Unchecked {
  std::vector<std::string> reasons;  ///< "CHECKS: REASON"
  bool checks_units = true;          ///< false: too few common poses for any check
};

/// The checks of frames and units that these data do not allow. `estimate`: with the stamps at
/// which these checks have compared it. O(1e5).
Unchecked unchecked_parts(const Trajectory& reference, const Trajectory& estimate);

}  // namespace loopbench::metrics
