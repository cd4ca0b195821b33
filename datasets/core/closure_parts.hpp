/// Groups of loop closures between two short stretches of a path.
#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

/// Limits of a part.
struct PartSize {
  std::size_t reach = 20;     ///< keyframes between an end of a closure and that of the first one
  std::size_t closures = 24;  ///< of one part
};

/// Returns the closures of each part, parts in the order of their first closure. Unlike
/// closure_places(), whose places grow as long as neighbours follow, a part is bounded: two laps
/// have parts all along, which can be checked by each other. O(closures log closures).
inline std::vector<std::vector<std::size_t>> closure_parts(const std::vector<Edge>& closures,
                                                           PartSize size = {}) {
  const auto apart = [](std::size_t a, std::size_t b) { return a < b ? b - a : a - b; };
  std::vector<std::vector<std::size_t>> out;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> begun;  // parts by tile
  const std::size_t side = size.reach + 1;
  const auto find = [&](const Edge& edge) {
    const std::size_t row = edge.from / side, column = edge.to / side;
    std::size_t best = out.size();
    for (const std::size_t r : {row, row + 1, row + 2}) {  // shifted by 1 to stay positive
      for (const std::size_t c : {column, column + 1, column + 2}) {
        const auto found = begun.find({r, c});
        if (found == begun.end()) continue;
        for (const std::size_t part : found->second) {
          const Edge& first = closures[out[part].front()];
          const bool is_near =
              apart(edge.from, first.from) <= size.reach && apart(edge.to, first.to) <= size.reach;
          if (is_near && part < best && out[part].size() < size.closures) best = part;
        }
      }
    }
    return best;
  };
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const Edge& edge = closures[k];
    const std::size_t part = find(edge);
    if (part == out.size()) {
      out.emplace_back();
      begun[{edge.from / side + 1, edge.to / side + 1}].push_back(part);
    }
    out[part].push_back(k);
  }
  return out;
}

}  // namespace loopbench
