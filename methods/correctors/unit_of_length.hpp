/// A monocular chain's creeping unit of length, taken out before its poses are corrected.
#pragma once

#include "datasets/core/problem.hpp"

namespace loopbench {

/// Whether an edge changes the unit of length: a problem of Sim(3).
bool changes_unit(const Problem& problem);

/// The same problem in one unit of length, the first keyframe's: a rigid one, whatever its edges'
/// scales were.
///
/// The logarithms of the units add up along the chain, whatever the poses do. With e_i ~ N(0, s^2)
/// the errors of the edges' log scales l_i and eta_k ~ N(0, s^2) those of the closures' L_k,
///
///     minimise sum e_i^2 + sum eta_k^2,   L_k - sum_{a <= i < b} (l_i + e_i) = eta_k,
///
/// is the scalar case of dual.hpp: (N + I) lambda = gaps, N_kl the number of edges that loops k and
/// l share, e_i the sum of lambda over the loops around edge i. Measured translations and their
/// deviations are then multiplied by the unit where they were measured, keyframes chained anew.
/// What a pose graph of Sim(3) has besides is that gaps in position tell of scale, too: with few
/// loops little, and nothing of it is used here. O(edges + closures^3).
/// Throws std::runtime_error when the equations cannot be solved.
/// Source: Dubbelman, Browning, COP-SLAM, T-RO 2015 spreads the loop's change of scale first, too.
Problem in_one_unit(const Problem& problem);

}  // namespace loopbench
