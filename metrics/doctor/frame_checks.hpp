/// Checks of conventions: quaternion order, inverted poses, mirrored or permuted axes.
#pragma once

#include <vector>

#include "datasets/core/trajectory.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

inline constexpr std::size_t kMostFramePoses = 2000;  ///< poses that are compared
inline constexpr std::size_t kFewestFramePoses = 20;  ///< fewer cannot be checked
inline constexpr double kLeastRotation = 0.05;        ///< smaller ones cannot be checked [rad]

/// Whether some rotation differs from the first one by more than kLeastRotation. O(poses).
bool has_rotations(const std::vector<Pose>& poses);

/// Compares how well both trajectories fit up to a similarity, as read and under each hypothesis
/// about one of them. Positions are compared after a least-squares similarity; rotations after the
/// constant rotations of world and body that fit best; axes by displacements in body frames, which
/// drift does not change. A hypothesis is reported if it removes most of a large residual. The
/// stamps must agree. O(1e5).
std::vector<InputFinding> check_frames(const Trajectory& reference, const Trajectory& estimate);

}  // namespace loopbench::metrics
