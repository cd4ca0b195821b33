/// Dual of group L1 trend filtering, solved by an interior-point method in about 30 Newton steps
/// for any data size.
#pragma once

#include <vector>

#include "datasets/core/so3.hpp"
#include "methods/smoothers/penalised/pentadiagonal.hpp"

namespace loopbench::methods {

struct TrendDual {
  std::vector<Vector3> forces;     ///< v_j, |v_j| < lambda; the fit is y - D'v
  std::vector<std::size_t> bends;  ///< rows j where D x is nonzero, ascending
  int iterations = 0;              ///< number of Newton steps
  bool converged = false;
};

/// Minimises 1/2 |D'v - y|^2 subject to |v_j| <= lambda, given outer = D D' and bends = D y, by
/// Newton steps on
///
///     t (1/2 v' D D' v - v' D y) - sum log(lambda^2 - |v_j|^2),
///
/// where t grows tenfold after each centring. The Hessian is block pentadiagonal: O(n) per step.
/// The duality gap is at most two per row over t. The solver stops when that bound is below
/// tolerance^2 / 2 |D'v|^2, so that x is within tolerance |y - x| of the optimum, or when rounding
/// prevents any decrease; `converged` then states whether the bound is below 1e-4 |D'v|^2. If no
/// constraint is active the answer is the regression line, which is computed directly. Sources:
/// Kim, Koh, Boyd & Gorinevsky, l1 trend filtering, 2009, section 5 (scalar case); Boyd &
/// Vandenberghe, Convex Optimization, 2004, 11.3 and 11.6 (barrier of a second-order cone).
TrendDual solve_trend_dual(const Pentadiagonal& outer,
                           const std::vector<Vector3>& bends,
                           double lambda,
                           double tolerance,
                           int most);

}  // namespace loopbench::methods
