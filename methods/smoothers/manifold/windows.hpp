/// Step 6: windows of nodes that are fitted together, and the part of the curve each fit covers.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "methods/smoothers/manifold/families/nodes.hpp"

namespace loopbench::methods::manifold {

/// consecutive: adjacent windows share their end nodes. sliding_blend: one window per edge, each
/// blended into the next. one_per_segment: nodes evenly subsampled from the segment. first_n: the
/// first nodes represent the segment. The article's "We select N keyframe pose nodes in each
/// segment" is compatible with all four.
enum class Scheme { consecutive, sliding_blend, one_per_segment, first_n };
inline auto choices(Scheme) {
  return std::array{std::pair{"consecutive", Scheme::consecutive},
                    std::pair{"sliding_blend", Scheme::sliding_blend},
                    std::pair{"one_per_segment", Scheme::one_per_segment},
                    std::pair{"first_n", Scheme::first_n}};
}

struct Window {
  NodeRange fitted;       ///< nodes the curve is fitted to
  NodeRange owned;        ///< part of the trajectory it covers; within `fitted` except for first_n
  std::size_t taken = 0;  ///< number of fitted nodes used, evenly subsampled; 0: all

  bool operator==(const Window&) const = default;
};

/// Whether `holds(point)` for three points of `spline` on each edge that the window owns, and on
/// one edge on either side.
template <class Spline, class Holds>
bool holds_along(const Nodes& nodes, const Spline& spline, const Window& window, Holds holds) {
  const std::size_t begin = window.owned.first > 0 ? window.owned.first - 1 : 0;
  const std::size_t end = std::min(window.owned.last + 1, nodes.size() - 1);
  for (std::size_t edge = begin; edge < end; ++edge) {
    for (const double u : {0.25, 0.5, 0.75}) {
      if (!holds(spline.at(edge, nodes.stamps[edge] + u * nodes.duration(edge)))) return false;
    }
  }
  return true;
}

inline NodeRange borrowing(NodeRange nodes, std::size_t size, std::size_t count) {
  while (nodes.nodes() < std::min(size, count)) {
    if (nodes.first > 0) --nodes.first;
    if (nodes.nodes() < size && nodes.last + 1 < count) ++nodes.last;
  }
  return nodes;
}

// Window around node `edge` for odd `size`, around the edge for even `size`; within the segment.
inline Window sliding(NodeRange segment, std::size_t edge, std::size_t size) {
  const std::size_t back = (size - 1) / 2;
  const std::size_t latest = segment.last + 1 - size;
  const std::size_t first = std::min(std::max(edge, segment.first + back) - back, latest);
  return {{first, first + size - 1}, {edge, edge + 1}};
}

/// Returns windows of `size` nodes over one segment. Consecutive windows share their end node; the
/// last one reuses earlier nodes. A segment with fewer nodes borrows nodes from its neighbours,
/// alternately from the earlier and the later one. A window has fewer nodes only if the trajectory
/// has fewer (`count`). `segment` must have at least two nodes, `size` >= 2. O(windows).
inline std::vector<Window> windows(NodeRange segment,
                                   std::size_t size,
                                   std::size_t count,
                                   Scheme scheme = Scheme::consecutive) {
  std::vector<Window> out;
  if (segment.nodes() < size) {
    const NodeRange fitted = borrowing(segment, size, count);
    if (scheme != Scheme::sliding_blend) return {{fitted, segment}};
    for (std::size_t edge = segment.first; edge < segment.last; ++edge) {
      out.push_back({fitted, {edge, edge + 1}});
    }
    return out;
  }
  if (scheme == Scheme::one_per_segment) return {{segment, segment, size}};
  if (scheme == Scheme::first_n) {
    return {{{segment.first, segment.first + size - 1}, segment}};
  }
  if (scheme == Scheme::sliding_blend) {
    for (std::size_t edge = segment.first; edge < segment.last; ++edge) {
      out.push_back(sliding(segment, edge, size));
    }
    return out;
  }
  for (std::size_t first = segment.first; first < segment.last;) {
    const std::size_t last = std::min(first + size - 1, segment.last);
    out.push_back({{last + 1 - size, last}, {first, last}});
    first = last;
  }
  return out;
}

/// Indices of the nodes that the window is fitted to. O(their number).
inline std::vector<std::size_t> picked(const Window& window) {
  const std::size_t nodes = window.fitted.nodes();
  const std::size_t taken = window.taken == 0 ? nodes : std::min(window.taken, nodes);
  std::vector<std::size_t> out;
  out.reserve(taken);
  for (std::size_t k = 0; k < taken; ++k) {
    // Rounded to the nearest node; gives all nodes when all are taken.
    const std::size_t parts = taken > 1 ? taken - 1 : 1;
    out.push_back(window.fitted.first + (2 * k * (nodes - 1) + parts) / (2 * parts));
  }
  return out;
}

}  // namespace loopbench::methods::manifold
