/// Estimates and removes the scale drift of a monocular chain before its poses are corrected.
#pragma once

#include "datasets/core/problem.hpp"

namespace loopbench::methods {

/// Whether an edge changes the scale (a Sim(3) problem).
bool has_scale_drift(const Problem& problem);

/// Returns a rigid problem in the scale of the first keyframe. Measured translations and their
/// deviations are multiplied by the scale of the keyframe where they were measured, and the
/// keyframes are re-integrated.
///
/// Let the log scale change by l_i + s_i over edge i, with l_i as measured and s_i ~ N(0, sigma^2).
/// A closure measures its change L_k with the same sigma. The error of a closure is then
///
///     sum_{a <= i < b} (l_i + s_i) - L_k                  in scale, and in pose by
///     c_k + A e + J_k sum_{a <= i < b} s_i [p_b - q_i; 0],  q_i where edge i ends,
///
/// because everything after edge i is scaled about q_i. The minimum-cost e_i and s_i follow from
/// one system of seven equations per closure, as in dual.hpp. Only the s_i are used; the system is
/// relinearised there until the cost converges. The initial s_i minimise the scale errors alone.
/// Together with the e_i that a rigid method then finds, this is the minimum of a Sim(3) pose
/// graph.
///
/// About a hundred times O(edges + (7 closures)^3). Throws std::runtime_error when the equations
/// cannot be solved. Source: Strasdat, Montiel, Davison, Scale drift-aware large scale monocular
/// SLAM, RSS 2010 (the problem); generalised least squares with few constraints (the solution).
Problem remove_scale_drift(const Problem& problem);

}  // namespace loopbench::methods
