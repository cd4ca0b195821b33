/// Step 4: what becomes of segments with fewer nodes than a window wants.
#pragma once

#include <array>

#include "datasets/core/problem.hpp"
#include "methods/smoothers/manifold/nodes.hpp"

namespace loopbench::manifold {

/// borrow_neighbours: their windows take nodes of the neighbours. merge: they join the neighbour
/// nearer in mean speed. polyline: straight lines. quasi_keyframes: tracked frames fill them up;
/// where there are none they borrow.
enum class Short { borrow_neighbours, merge, polyline, quasi_keyframes };
inline auto choices(Short) {
  return std::array{std::pair{"borrow_neighbours", Short::borrow_neighbours},
                    std::pair{"merge", Short::merge},
                    std::pair{"polyline", Short::polyline},
                    std::pair{"quasi_keyframes", Short::quasi_keyframes}};
}

/// Segments with fewer than `least` nodes joined, left to right, to the neighbour whose mean speed
/// is nearer; both rules of segmentation are relaxed there. O(n).
std::vector<NodeRange> merged(const Nodes& nodes, std::vector<NodeRange> runs, std::size_t least);

/// Nodes and segments after tracked frames were added.
struct Filled {
  Trajectory nodes;
  std::vector<NodeRange> runs;
  std::size_t inserted = 0;
};

/// Every edge of a segment with fewer than `least` nodes is cut into as many equal parts as the
/// segment lacks, and the tracked frame nearest to each cut becomes a node. O(n log frames).
Filled filled(const Trajectory& nodes,
              const std::vector<NodeRange>& runs,
              const Trajectory& frames,
              std::size_t least);

}  // namespace loopbench::manifold
