/// Helpers for the tables of a profile.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "harness/model/record.hpp"

namespace loopbench::harness {

/// Cells by method, methods in order of first appearance.
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

/// Whether the method used the reference in some cell.
inline bool is_oracle(const std::vector<const CellRecord*>& cells) {
  return std::ranges::any_of(cells, [](const CellRecord* cell) { return cell->oracle; });
}

/// Name of the method in tables.
inline std::string table_name(const std::string& method,
                              const std::vector<const CellRecord*>& cells) {
  return method + (is_oracle(cells) ? " (oracle)" : "");
}

/// Note on "(oracle)" and on sequences with closures from the reference; empty if neither occurs.
inline std::vector<std::string> oracle_notes(const std::vector<CellRecord>& cells) {
  std::vector<std::string> out;
  std::vector<std::string> measured;
  for (const CellRecord& cell : cells) {
    if (cell.oracle && out.empty()) {
      out.emplace_back("oracle: the method or its data uses the reference");
    }
    if (cell.oracle_closures && std::ranges::count(measured, cell.sequence.text()) == 0) {
      measured.push_back(cell.sequence);
    }
  }
  std::string names;
  for (const std::string& name : measured) names += (names.empty() ? "" : ", ") + name;
  if (!names.empty())
    out.push_back("closures are oracle (measured in the reference or selected by it): " + names);
  return out;
}

/// Note of tables for cells that have results, but no times.
inline constexpr const char* kNoTimes =
    "none: no run times are recorded, because the results are those of files (`eval --store`)";

/// Whether there are results, but all without times.
inline bool lacks_times(const std::vector<CellRecord>& cells) {
  return std::ranges::none_of(cells, [](const auto& cell) { return cell.runs > 0; }) &&
         std::ranges::any_of(cells, [](const auto& cell) { return has_numbers(cell.status); });
}

/// Whether the method of the cell finished.
inline bool is_finished(const CellRecord& cell) {
  return cell.runs > 0 && has_numbers(cell.status);
}

}  // namespace loopbench::harness
