/// Order in which the poses of a graph are eliminated.
#pragma once

#include <cstddef>
#include <vector>

namespace loopbench::methods {

/// Approximate minimum degree of the graph on `poses` (ascending) in which each list of `cliques`
/// is fully connected; other members of cliques are ignored. The last pose is put last, because the
/// next edges concern it. Deterministic. Source: Amestoy, Davis, Duff, An approximate minimum
/// degree ordering algorithm, SIMAX 17(4), 1996 (Eigen's implementation).
std::vector<std::size_t> elimination_order(const std::vector<std::size_t>& poses,
                                           const std::vector<std::vector<std::size_t>>& cliques);

}  // namespace loopbench::methods
