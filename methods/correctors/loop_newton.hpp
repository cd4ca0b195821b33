/// Newton's step for a chain with loops: what Gauss-Newton leaves out, put back.
#pragma once

#include "methods/correctors/loop_equations.hpp"

namespace loopbench {

/// Gauss-Newton takes a loop's error eta for linear in the edges' errors. With twists
/// x_i = edge[i] e_i seen from the world, a loop really closes by
///
///     sum x_i + 1/2 sum_{i<j} [x_i, x_j]     (Baker, Campbell, Hausdorff),
///
/// so that its multiplier lambda adds N_ij = 1/2 edge[i]' B(q) edge[j], i < j, to the Hessian: q is
/// the sum of loop[k]' lambda_k over the loops around both edges, x' B(q) y = q' [x, y]. On long
/// levers that decides how fast one converges; without it KITTI 00 takes hundreds of steps. Terms
/// that vanish with the errors themselves are left out.
///
/// Solves (M + N) d = -gradient, M being Gauss-Newton's Hessian, by conjugate gradients
/// preconditioned with M^-1. N d and M^-1 d are running sums: O(edges + closures^2) an iteration,
/// at most 50. Where curvature is not positive it stops (Steihaug); the first iterate is
/// Gauss-Newton's direction, scaled.
///
/// Unknown are the edges' noise and the drift, and the gradient is by them; returned is the change
/// of errors and drift. Source: Nocedal & Wright, Numerical optimization, 2006, 7.1 and 18.3.
Corrections newton_direction(const LoopEquations& equations,
                             const Corrections& gradient,
                             const LoopSums& sums,
                             const std::vector<Edge>& closures,
                             const ChainBelief& belief);

}  // namespace loopbench
