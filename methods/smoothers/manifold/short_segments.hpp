/// Step 4: treatment of segments with fewer nodes than a window.
#pragma once

#include <array>

#include "datasets/core/problem.hpp"
#include "methods/smoothers/manifold/nodes.hpp"

namespace loopbench::methods::manifold {

/// borrow_neighbours: their windows include nodes of the neighbouring segments. merge: they are
/// merged with the neighbour of the most similar mean speed. polyline: straight lines.
/// quasi_keyframes: tracked frames are inserted; without such frames nodes are borrowed.
enum class ShortPolicy { borrow_neighbours, merge, polyline, quasi_keyframes };
inline auto choices(ShortPolicy) {
  return std::array{std::pair{"borrow_neighbours", ShortPolicy::borrow_neighbours},
                    std::pair{"merge", ShortPolicy::merge},
                    std::pair{"polyline", ShortPolicy::polyline},
                    std::pair{"quasi_keyframes", ShortPolicy::quasi_keyframes}};
}

/// Merges segments with fewer than `min_nodes` nodes, left to right, with the neighbour of the most
/// similar mean speed, regardless of the segmentation rules. O(n).
std::vector<NodeRange> merge_short_segments(const Nodes& nodes,
                                            std::vector<NodeRange> runs,
                                            std::size_t min_nodes);

/// Nodes and segments after the insertion of tracked frames.
struct FilledSegments {
  Trajectory nodes;
  std::vector<NodeRange> runs;
  std::size_t inserted = 0;
};

/// Divides every edge of a segment with fewer than `min_nodes` nodes into as many equal parts as
/// are needed to reach `min_nodes`, and inserts the tracked frame nearest to each division. O(n log
/// frames).
FilledSegments fill_short_segments(const Trajectory& nodes,
                                   const std::vector<NodeRange>& runs,
                                   const Trajectory& frames,
                                   std::size_t min_nodes);

}  // namespace loopbench::methods::manifold
