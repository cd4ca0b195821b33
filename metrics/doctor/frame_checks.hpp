/// Checks of conventions: quaternion order, inverted poses, mirrored or permuted axes.
#pragma once

#include <vector>

#include "datasets/core/trajectory.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// Compares how well both trajectories fit up to a similarity, as read and under each hypothesis
/// about one of them. Positions are compared after a least-squares similarity; rotations after the
/// constant rotations of world and body that fit best; axes by displacements in body frames, which
/// drift does not change. A hypothesis is reported if it removes most of a large residual. The
/// stamps must agree. O(1e5).
std::vector<InputFinding> check_frames(const Trajectory& reference, const Trajectory& estimate);

}  // namespace loopbench::metrics
