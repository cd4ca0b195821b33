/// Check for different bodies of reference and estimate.
#pragma once

#include <optional>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

struct LeverArm {
  InputFinding finding;
  Pose body_from_reference;  ///< of the estimate's body, in the reference's scale
};

/// A finding if a lever arm between the bodies explains at least half of the differences of
/// displacements over rotations, see extrinsic_offset(). The stamps, axes and units must agree.
/// O(1e5).
std::optional<LeverArm> find_lever_arm(const Trajectory& reference, const Trajectory& estimate);

/// Adds a lever arm to `conventions`, the findings about frames and units, if these are at most a
/// scale. A lever arm can look like a scale when the body circles an object: a finding of a scale
/// that disappears once the lever arm is corrected is removed. O(1e5).
void add_lever_arm(std::vector<InputFinding>& conventions,
                   const Trajectory& reference,
                   const Trajectory& estimate);

/// A finding if rotations agree, after alignment of the positions, only up to a constant rotation
/// of the body by more than 30 deg: camera axes beside those of a vehicle. No position error
/// depends on it. Only where rotations vary, since the alignment of a straight path is ambiguous.
/// The stamps, axes and units must agree. O(1e5).
std::optional<InputFinding> find_body_rotation(const Trajectory& reference,
                                               const Trajectory& estimate);

}  // namespace loopbench::metrics
