#include "methods/smoothers/manifold/windows.hpp"

#include <algorithm>

namespace loopbench::manifold {
namespace {

NodeRange borrowing(NodeRange nodes, std::size_t size, std::size_t count) {
  while (nodes.nodes() < std::min(size, count)) {
    if (nodes.first > 0) --nodes.first;
    if (nodes.nodes() < size && nodes.last + 1 < count) ++nodes.last;
  }
  return nodes;
}

}  // namespace

std::vector<Window> windows(NodeRange segment, std::size_t size, std::size_t count) {
  if (segment.nodes() < size) return {{borrowing(segment, size, count), segment}};
  std::vector<Window> out;
  for (std::size_t first = segment.first; first < segment.last;) {
    const std::size_t last = std::min(first + size - 1, segment.last);
    out.push_back({{last + 1 - size, last}, {first, last}});
    first = last;
  }
  return out;
}

}  // namespace loopbench::manifold
