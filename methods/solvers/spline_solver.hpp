/// Nonlinear least squares for the controls of a cumulative B-spline on SO(3) x R^3.
#pragma once

#include <vector>

#include "methods/solvers/spline_factor.hpp"

namespace loopbench::methods {

/// Minimises half the sum of |e|^2 over poses and of e' Omega e over edges. Translation and
/// rotation of the poses share no unknown, so no weight between [m] and [rad] is needed.
struct SplineProblem {
  std::vector<PoseAt> poses;
  std::vector<EdgeBetween> edges;
  bool fix_start = false;  ///< keep the first control, the start of the curve, fixed
};

struct SplineSettings {
  int max_iterations = 100;
  double tolerance = 1e-16;  ///< relative change of the cost at convergence [-]
};

struct SplineSummary {
  int iterations = 0;
  double cost_before = 0.0;
  double cost = 0.0;
  bool converged = false;  ///< reached the tolerance before max_iterations
};

/// Minimises the problem over the controls, one per basis function. Levenberg-Marquardt, analytic
/// Jacobians (spline_factor.hpp), sparse Cholesky, one thread; results are bit-identical between
/// runs. O(n k^2) per iteration for n factors, plus the fill-in of long edges. Throws
/// std::runtime_error with the message of Ceres when there is no usable solution, and when an
/// information matrix is not positive definite.
SplineSummary solve_spline(const SplineBasis& basis,
                           std::vector<Pose>& controls,
                           const SplineProblem& problem,
                           const SplineSettings& settings);

}  // namespace loopbench::methods
