/// The dual of group L1 trend filtering, by an interior-point method: some 30 Newton steps, however
/// long the data.
#pragma once

#include <vector>

#include "datasets/core/so3.hpp"
#include "methods/smoothers/penalised/pentadiagonal.hpp"

namespace loopbench {

struct TrendDual {
  std::vector<Vector3> forces;     ///< v_j, |v_j| < lambda; the fit is y - D'v
  std::vector<std::size_t> bends;  ///< rows j where D x is not zero, ascending
  int iterations = 0;              ///< Newton steps
  bool converged = false;
};

/// Minimises 1/2 |D'v - y|^2 subject to |v_j| <= lambda, given outer = D D' and bends = D y, by
/// Newton steps on
///
///     t (1/2 v' D D' v - v' D y) - sum log(lambda^2 - |v_j|^2),
///
/// t tenfold each time they have settled. The Hessian is block-pentadiagonal: O(n) a step. Ends
/// when the objective, two a row over t above its least, is within tolerance^2 / 2 |D'v|^2 of it,
/// which puts x within tolerance |y - x| of the optimum; or when rounding lets nothing fall any
/// more
/// (`converged` then says whether it is within a ten-thousandth of |D'v|^2).
/// Where lambda binds nowhere the answer is the straight line, found directly.
/// Sources: Kim, Koh, Boyd & Gorinevsky, l1 trend filtering, 2009, section 5 (for scalars); Boyd &
/// Vandenberghe, Convex optimization, 2004, 11.3 and 11.6 (the barrier of a second-order cone).
TrendDual solve_trend_dual(const Pentadiagonal& outer,
                           const std::vector<Vector3>& bends,
                           double lambda,
                           double tolerance,
                           int most);

}  // namespace loopbench
