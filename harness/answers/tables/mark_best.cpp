#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "harness/answers/compare/verdict.hpp"
#include "harness/answers/tables/table_numbers.hpp"

namespace loopbench::harness {
namespace {

/// A column or a row.
struct Lane {
  std::optional<ObservationsBuilder> observed = {};  ///< none without a score that has a direction
  std::map<SharedText, std::size_t> entries = {};    ///< column or row by method
  std::set<SharedText> several = {};                 ///< methods with more entries
};

/// The fields that records of cells without scores have, too.
std::vector<std::string> fields_of_cells(std::vector<std::string> names) {
  std::erase_if(names, [](const std::string& name) {
    return name != "sequence" && name != "repeat" && name != "method" && name != "closures" &&
           name != "status";
  });
  return names;
}

std::vector<Lane> lanes_of(const TableNumbers& table, const TableSpec& spec, bool along_columns) {
  std::vector<Lane> out((along_columns ? table.columns : table.rows).names().size());
  const std::vector<std::string> names = fields_of_cells(along_columns ? spec.columns : spec.rows);
  std::unordered_map<std::string, std::vector<std::size_t>> by_cell;
  for (const PlacedRecord& placed : table.records) {
    const Record& r = *placed.record;
    if (!placed.column) continue;
    const auto [row, column] = std::pair(placed.row, *placed.column);
    const std::size_t number = along_columns ? column : row;
    Lane& lane = out[number];
    if (!lane.observed && direction_of(*r.kind, spec.value) != metrics::Better::neither) {
      lane.observed.emplace(spec.value);
      by_cell[fields_joined(r, names, "\n")].push_back(number);
    }
    const std::size_t entry = along_columns ? row : column;
    if (lane.entries.emplace(r.cell->method, entry).first->second != entry)
      lane.several.insert(r.cell->method);
  }
  // In the order of the records, because the last one of a run counts.
  for (const PlacedRecord& placed : table.records) {
    const Record& r = *placed.record;
    if (placed.column) {
      Lane& lane = out[along_columns ? *placed.column : placed.row];
      if (lane.observed) lane.observed->add(r);
      continue;
    }
    const auto found = by_cell.find(fields_joined(r, names, "\n"));
    if (found == by_cell.end()) continue;
    for (const std::size_t number : found->second) out[number].observed->add(r);
  }
  return out;
}

/// Empty if a value is best, or nothing is compared. Of `tested` columns or rows, which share the
/// level, so more groups are needed than for a single score.
std::string why_none_is_best(const Comparison& c, std::size_t tested, const char* lanes) {
  if (c.is_best || c.methods.empty()) return "";
  if (c.can_show) return coverage_text(c, true);
  const std::string why = cannot_show_text(c);
  return tested > 1 ? fmt::format("{} because {} {} are tested", why, tested, lanes) : why;
}

/// Whether the means of the best methods are before those of all others.
bool do_means_agree(const std::vector<TableCell*>& best,
                    const std::vector<TableCell*>& others,
                    const ScoreKind& kind) {
  const auto loss = [&](const TableCell* cell) {
    if (kind.better == metrics::Better::target) return std::abs(*cell->value - kind.target);
    return kind.better == metrics::Better::higher ? -*cell->value : *cell->value;
  };
  const auto is_before_others = [&](const TableCell* one) {
    return one->value && std::ranges::none_of(others, [&](const TableCell* other) {
             return other->value && loss(other) < loss(one);
           });
  };
  return std::ranges::all_of(best, is_before_others);
}

bool is_comparable(const Lane& lane) { return lane.observed && lane.entries.size() > 1; }

}  // namespace

void mark_best(Table& out, const TableNumbers& table, const TableSpec& spec, bool along_columns) {
  bool is_marked = false;
  std::string why_none;
  std::vector<Lane> lanes = lanes_of(table, spec, along_columns);
  const auto tested = static_cast<std::size_t>(std::ranges::count_if(lanes, is_comparable));
  const CompareOptions options;
  for (std::size_t l = 0; l < lanes.size(); ++l) {
    Lane& lane = lanes[l];
    if (!is_comparable(lane)) continue;
    std::vector<Observations> scores = lane.observed->build();
    const bool is_one = scores.size() == 1 &&
                        std::ranges::none_of(scores[0].methods, [&](const std::string& method) {
                          return lane.several.contains(method);
                        });
    if (!is_one) continue;
    const Comparison c =
        standings(std::move(scores[0]),
                  {.value = spec.value, .alpha = options.alpha / static_cast<double>(tested)});
    if (why_none.empty())
      why_none = why_none_is_best(c, tested, along_columns ? "columns" : "rows");
    if (!c.is_best) continue;
    std::vector<TableCell*> best, others;
    for (const MethodVerdict& m : c.methods) {
      const std::size_t entry = lane.entries.at(m.method);
      TableCell& cell = out.lines[along_columns ? entry : l][1 + (along_columns ? l : entry)];
      (m.is_worse ? others : best).push_back(&cell);
    }
    if (!do_means_agree(best, others, c.kind)) continue;
    for (TableCell* cell : best) cell->is_best = true;
    is_marked = true;
  }
  if (is_marked) {
    out.marks = {along_columns, tested};
    out.notes.insert(out.notes.begin(), marks_text(*out.marks));
  } else if (!why_none.empty()) {
    out.notes.push_back("no best value is marked: " + why_none);
  }
}

}  // namespace loopbench::harness
