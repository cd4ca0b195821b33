/// Maximum likelihood of a growing pose graph, with a Cholesky factorisation that is updated.
#pragma once

#include <array>
#include <memory>
#include <utility>

#include "methods/incremental.hpp"

namespace loopbench::methods {

/// What is done about false closures: nothing; `gate`: a closure that raises the cost too much is
/// rejected; `graduated`: closures are weighted by a loss that becomes less and less convex.
enum class IncrementalRobustness { none, gate, graduated };
inline auto choices(IncrementalRobustness) {
  return std::array{std::pair{"none", IncrementalRobustness::none},
                    std::pair{"gate", IncrementalRobustness::gate},
                    std::pair{"graduated", IncrementalRobustness::graduated}};
}

struct IncrementalSettings {
  double tolerance = 1e-6;   ///< largest correction without a new linearisation [m], [rad]
  double decrease = 1e-8;    ///< smallest decrease, relative to the cost, that is worth one
  int max_iterations = 100;  ///< linearisations per update
  IncrementalRobustness robust = IncrementalRobustness::none;
};

/// Minimises the cost of solve_pose_graph() without loss, in SE(2) or SE(3). Keyframe 0 is fixed.
///
/// The poses are eliminated one by one. Each keeps its rows of the Cholesky factor and the Schur
/// complement that it leaves on its separator, the later poses that it is connected to; the first
/// of these is its parent. New, withdrawn and relinearised edges concern the poses at their ends
/// and all ancestors of these in the elimination tree; only those are ordered (minimum degree, the
/// newest one last) and eliminated again. Corrections are propagated down the tree as far as they
/// change. A pose is relinearised when its correction exceeds the tolerance, until none does, or
/// until the next decrease of the cost, extrapolated from the last two, is below `decrease`.
///
/// On a chain, a closure concerns the poses along its loop, so an update is O(loop) with a factor
/// for the number of loops that overlap there, and O(keyframes) for the copy of the result. A new
/// keyframe starts from the last solution and its odometry; odometry must be complete. Throws
/// std::runtime_error if the normal equations are not positive definite.
///
/// With `gate`, closures are added one by one, and a closure is removed again if it raises chi2,
/// the minimum of the cost, by more than the 99 % quantile of its distribution: for a true closure
/// and correct covariances, the increase is chi-squared with the dimensions of a pose. A closure
/// whose chi2 at the present poses is below that is accepted without a solution of its own. It is
/// the test of IPC without its limitation to the loops that overlap: Olivastri and Pretto, IPC:
/// incremental probabilistic consensus-based consistent set maximization, IROS 2024 (arXiv
/// 2405.08503).
///
/// With `graduated`, closures have the weights of graduated_loss.hpp, with that quantile as scale.
/// When closures arrive, these and all closures of the poses that they move begin convex (mu = 0)
/// and are hardened to mu = 1, so a closure that was accepted can be rejected later, and the other
/// way round. Next time, a closure that is outside the quantile at the end begins at the next mu,
/// and one that fits 0.1 lower, so that old decisions become firm. After McGann, Rogers, Kaess,
/// Robust incremental smoothing and mapping (riSAM), ICRA 2023 (arXiv 2209.14359), without its line
/// search.
///
/// Source: Kaess, Johannsson, Roberts, Ila, Leonard, Dellaert, iSAM2: incremental smoothing and
/// mapping using the Bayes tree, IJRR 31(2), 2012; here with single poses instead of cliques, and
/// normal equations instead of QR.
std::unique_ptr<Incremental> incremental_smoother(bool planar, const IncrementalSettings& settings);

}  // namespace loopbench::methods
