/// Maximum likelihood of a growing pose graph, with a Cholesky factorisation that is updated.
#pragma once

#include <memory>

#include "methods/incremental.hpp"

namespace loopbench::methods {

struct IncrementalSettings {
  double tolerance = 1e-6;   ///< largest change of a pose at convergence [m], [rad]
  int max_iterations = 100;  ///< linearisations per update
  bool gate = false;         ///< reject closures that raise the cost too much
};

/// Minimises the cost of solve_pose_graph() without loss, in SE(2) or SE(3). Keyframe 0 is fixed.
///
/// The poses are eliminated one by one. Each keeps its rows of the Cholesky factor and the Schur
/// complement that it leaves on its separator, the later poses that it is connected to; the first
/// of these is its parent. New, withdrawn and relinearised edges concern the poses at their ends
/// and all ancestors of these in the elimination tree; only those are ordered (minimum degree, the
/// newest one last) and eliminated again. Corrections are propagated down the tree as far as they
/// change. A pose is relinearised when its correction exceeds the tolerance, until none does.
///
/// On a chain, a closure concerns the poses along its loop, so an update is O(loop) with a factor
/// for the number of loops that overlap there, and O(keyframes) for the copy of the result. A new
/// keyframe starts from the last solution and its odometry; odometry must be complete. Throws
/// std::runtime_error if the normal equations are not positive definite.
///
/// With `gate`, closures are added one by one, and a closure is removed again if it raises chi2,
/// the minimum of the cost, by more than the 99 % quantile of its distribution: for a true closure
/// and correct covariances, the increase is chi-squared with the dimensions of a pose. It is the
/// test of IPC without its limitation to the loops that overlap: Olivastri and Pretto, IPC:
/// incremental probabilistic consensus-based consistent set maximization, IROS 2024 (arXiv
/// 2405.08503).
///
/// Source: Kaess, Johannsson, Roberts, Ila, Leonard, Dellaert, iSAM2: incremental smoothing and
/// mapping using the Bayes tree, IJRR 31(2), 2012; here with single poses instead of cliques, and
/// normal equations instead of QR.
std::unique_ptr<Incremental> incremental_smoother(bool planar, const IncrementalSettings& settings);

}  // namespace loopbench::methods
