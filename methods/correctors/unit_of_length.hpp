/// A monocular chain's creeping unit of length, taken out before its poses are corrected.
#pragma once

#include "datasets/core/problem.hpp"

namespace loopbench {

/// Whether an edge changes the unit of length: a problem of Sim(3).
bool changes_unit(const Problem& problem);

/// The same problem in one unit of length, the first keyframe's: a rigid one, whatever its edges'
/// scales were. Measured translations and their deviations are multiplied by the unit where they
/// were measured, keyframes chained anew.
///
/// Let the logarithm of the unit change by l_i + s_i over edge i, l_i as measured, s_i ~ N(0,
/// sigma^2), and closures measure its change L_k as well as edges do. A closure is then off by
///
///     sum_{a <= i < b} (l_i + s_i) - L_k                  in scale, and in pose by
///     c_k + A e + J_k sum_{a <= i < b} s_i [p_b - q_i; 0],  q_i where edge i ends,
///
/// for what comes after edge i grows about q_i. The e_i and s_i of least cost come from one system
/// of seven equations a closure, as in dual.hpp; of them the s_i are taken, and the system is set
/// up anew there until the cost rests. The first s_i are those that scales alone ask for. With the
/// e_i that a rigid method then finds, this is the minimum of a pose graph of Sim(3).
///
/// O(edges + (7 closures)^3) some ten times ten. Throws std::runtime_error when the equations
/// cannot be solved. Source: Strasdat, Montiel, Davison, Scale drift-aware large scale monocular
/// SLAM, RSS 2010 (the problem); generalised least squares with few constraints (its solution).
Problem in_one_unit(const Problem& problem);

}  // namespace loopbench
