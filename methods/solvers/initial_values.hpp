/// Initial values of a pose-graph optimisation.
#pragma once

#include <optional>
#include <vector>

#include "methods/solvers/elimination_structure.hpp"
#include "methods/solvers/groups/scaled_pose.hpp"

namespace loopbench::methods {

/// Integrates poses from keyframe 0 along a spanning tree that prefers odometry to closures and
/// takes closures in their order; scales are integrated as well. A keyframe that no edge reaches
/// keeps its pose. O(keyframes + edges).
std::vector<ScaledPose> tree_values(const Problem& problem);

/// Returns the first keyframe that is not connected to keyframe 0, or nullopt. O(keyframes +
/// edges).
std::optional<std::size_t> first_unconnected(const Problem& problem);

/// Chordal relaxation. Computes rotations by linear least squares on their nine entries,
///     min sum kappa |R_j - R_i Z_R|^2 (Frobenius), R_0 fixed, then projects each to SO(3);
/// then the log scales and then the positions by linear least squares given the results so far.
/// kappa and tau are the inverse mean variances of rotation and translation. Three sparse
/// factorisations. All closures have full weight, so they must be free of outliers. Throws
/// std::runtime_error when a system is singular (the graph is not connected). Source: Martinec and
/// Pajdla, CVPR 2007; Carlone, Tron, Daniilidis, Dellaert, ICRA 2015.
std::vector<ScaledPose> chordal_values(const Problem& problem,
                                       double scale_sigma,
                                       EliminationCache& cache);

}  // namespace loopbench::methods
