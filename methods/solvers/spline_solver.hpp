/// Nonlinear least squares for the controls of a cumulative B-spline on SO(3) x R^3.
#pragma once

#include <vector>

#include "methods/solvers/spline_factor.hpp"

namespace loopbench {

/// Half the sum of |e|^2 over poses (their two halves share no unknown, so a weight between [m] and
/// [rad] would not matter) and of e' Omega e over edges is what is minimised.
struct SplineProblem {
  std::vector<PoseAt> poses;
  std::vector<EdgeBetween> edges;
  bool hold_start = false;  ///< the first control, which is where the curve starts, does not move
};

struct SplineSettings {
  int max_iterations = 100;
  double tolerance = 1e-16;  ///< relative change of the cost that ends it [-]
};

struct SplineSummary {
  int iterations = 0;
  double cost_before = 0.0;
  double cost = 0.0;
  bool converged = false;  ///< false: the iterations ran out first
};

/// Moves the controls, one for each function of the basis, to a minimum. Levenberg-Marquardt,
/// analytic Jacobians (spline_factor.hpp), sparse Cholesky, one thread: the same bits every time.
/// O(n k^2) an iteration for n factors, and the fill-in of long edges. Throws std::runtime_error
/// with Ceres's own words when there is no usable solution, or when information is not positive
/// definite.
SplineSummary fit_controls(const SplineBasis& basis,
                           std::vector<Pose>& controls,
                           const SplineProblem& problem,
                           const SplineSettings& settings);

}  // namespace loopbench
