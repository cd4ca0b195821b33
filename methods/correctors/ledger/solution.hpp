/// Minima of a problem with its stated covariances, for the ledger of closures.
#pragma once

#include <vector>

#include "methods/solvers/pose_graph_solver.hpp"

namespace loopbench::methods {

struct LedgerSolution {
  std::vector<ScaledPose> poses;
  double chi2 = 0.0;  ///< sum of squared Mahalanobis errors
  PoseGraphSettings settings;
};

/// Minimum of a problem without a loss, from chordal relaxation and, if chi2 is large there, from
/// the keyframes: the lower one. Throws std::runtime_error when the solver finds none.
LedgerSolution ledger_solution(const Problem& problem);

}  // namespace loopbench::methods
