/// Several odometry edges read as one.
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

/// a: i -> j, b: j -> k gives i -> k. Covariances add after a's is carried to k by the adjoint:
///   S_ik = Ad(b^-1) S_ij Ad(b^-1)^T + S_jk,
/// first order in the noise. Scales multiply, and the lengths of b and of S_jk are turned from the
/// unit of j into that of i.
/// Throws std::invalid_argument when an information is not positive definite.
Edge compose(const Edge& a, const Edge& b);

/// The chain's edges between kept poses, renumbered by position in `kept`. `chain[i]` joins i and
/// i + 1; kept is ascending. An edge that skips nothing is passed on bit for bit. O(chain).
std::vector<Edge> bridge(const std::vector<Edge>& chain, const std::vector<std::size_t>& kept);

}  // namespace loopbench
