/// Small helpers that the tables of a profile share.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "harness/store/record.hpp"

namespace loopbench {

/// Cells by method, methods in the order in which they first appear.
inline std::vector<std::pair<std::string, std::vector<const CellRecord*>>> by_method(
    const std::vector<CellRecord>& cells) {
  std::vector<std::pair<std::string, std::vector<const CellRecord*>>> out;
  for (const CellRecord& cell : cells) {
    auto found = std::ranges::find_if(out, [&](const auto& g) { return g.first == cell.method; });
    if (found == out.end()) found = out.insert(out.end(), {cell.method, {}});
    found->second.push_back(&cell);
  }
  return out;
}

/// Its method ran to its end.
inline bool is_timed(const CellRecord& cell) {
  return cell.runs > 0 && (cell.status == "ok" || cell.status == "incomplete");
}

/// Of at least one value.
inline double median_of(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace loopbench
