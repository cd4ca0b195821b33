/// Newton step for a chain with loops: Gauss-Newton plus the second-order term of the loops.
#pragma once

#include "methods/correctors/loop_equations.hpp"

namespace loopbench::methods {

/// Gauss-Newton assumes that a loop's error eta is linear in the edge errors. With twists x_i =
/// edge[i] e_i in the world frame, a loop closes by
///
///     sum x_i + 1/2 sum_{i<j} [x_i, x_j]     (Baker, Campbell, Hausdorff),
///
/// so its multiplier lambda adds N_ij = 1/2 edge[i]' B(q) edge[j], i < j, to the Hessian. Here q is
/// the sum of loop[k]' lambda_k over the loops that enclose both edges, and x' B(q) y = q' [x, y].
/// With long lever arms this term determines the rate of convergence; without it KITTI 00 takes
/// hundreds of steps. Terms that vanish with the errors are neglected.
///
/// Solves (M + N) d = -gradient, where M is the Gauss-Newton Hessian, by conjugate gradients
/// preconditioned with M^-1. N d and M^-1 d are running sums: O(edges + closures^2) per iteration,
/// at most 50 iterations. The solver stops at negative curvature (Steihaug); its first iterate is a
/// multiple of the Gauss-Newton direction.
///
/// The unknowns are the errors of the edges; `gradient` is with respect to them. Returns the change
/// of the errors. Source: Nocedal & Wright, Numerical Optimization, 2006, sections 7.1 and 18.3.
std::vector<Twist> newton_direction(const LoopEquations& equations,
                                    const std::vector<Twist>& gradient,
                                    const LoopSums& sums,
                                    const std::vector<Edge>& closures,
                                    const NoiseModel& noise_model);

}  // namespace loopbench::methods
