/// Where a pose graph's minimisation starts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "methods/solvers/groups/scaled_pose.hpp"

namespace loopbench {

/// Poses chained from keyframe 0 along a spanning tree that takes odometry before closures, and
/// closures in their order; scales are carried. The keyframe no edge leads to keeps its place.
/// O(keyframes + edges).
std::vector<ScaledPose> tree_values(const Problem& problem);

/// The first keyframe that no edges join to keyframe 0, or nothing. O(keyframes + edges).
std::optional<std::size_t> first_unjoined(const Problem& problem);

/// Chordal relaxation: rotations by linear least squares on their nine entries,
///     min sum kappa |R_j - R_i Z_R|^2 (Frobenius), R_0 given, then each put back on SO(3);
/// logarithms of scales and then positions by linear least squares given those. kappa and tau are
/// the inverse mean variances of rotation and translation. Three sparse factorisations; closures
/// must be true, for every edge counts in full. Throws std::runtime_error when a system is singular
/// (the graph is not connected).
/// Source: Martinec and Pajdla, CVPR 2007; Carlone, Tron, Daniilidis, Dellaert, ICRA 2015.
std::vector<ScaledPose> chordal_values(const Problem& problem, double scale_sigma);

}  // namespace loopbench
