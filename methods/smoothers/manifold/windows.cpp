#include "methods/smoothers/manifold/windows.hpp"

#include <algorithm>

namespace loopbench::methods::manifold {
namespace {

NodeRange borrowing(NodeRange nodes, std::size_t size, std::size_t count) {
  while (nodes.nodes() < std::min(size, count)) {
    if (nodes.first > 0) --nodes.first;
    if (nodes.nodes() < size && nodes.last + 1 < count) ++nodes.last;
  }
  return nodes;
}

// Window around node `edge` for odd `size`, around the edge for even `size`; within the segment.
Window sliding(NodeRange segment, std::size_t edge, std::size_t size) {
  const std::size_t back = (size - 1) / 2;
  const std::size_t latest = segment.last + 1 - size;
  const std::size_t first = std::min(std::max(edge, segment.first + back) - back, latest);
  return {{first, first + size - 1}, {edge, edge + 1}};
}

}  // namespace

std::vector<Window> windows(NodeRange segment, std::size_t size, std::size_t count, Scheme scheme) {
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

std::vector<std::size_t> picked(const Window& window) {
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
