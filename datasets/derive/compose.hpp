/// Composition of consecutive odometry edges.
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

/// Composes edges a: i -> j and b: j -> k to i -> k. The covariance of a is transported to k by the
/// adjoint:
///   S_ik = Ad(b^-1) S_ij Ad(b^-1)^T + S_jk,
/// to first order in the noise. Scales are multiplied; the translation of b and S_jk are converted
/// from the scale of j to that of i. Throws std::invalid_argument if an information matrix is not
/// positive definite.
Edge compose(const Edge& a, const Edge& b);

/// Composes the edges of a chain between the poses `kept` (ascending) and renumbers them by
/// position in `kept`. chain[i] connects i and i + 1. Edges between consecutive kept poses are
/// copied unchanged. O(chain).
std::vector<Edge> bridge(const std::vector<Edge>& chain, const std::vector<std::size_t>& kept);

}  // namespace loopbench
