#include "harness/tables/table_numbers.hpp"

#include <string_view>

#include "harness/tables/common_runs.hpp"

namespace loopbench::harness {
namespace {

/// Runs that the entries of a column (or a row) tried and finished.
std::vector<EntryRuns> entry_runs(const TableNumbers& table,
                                  const std::vector<TablePosition>& entry_indices,
                                  bool along_columns) {
  std::vector<EntryRuns> out;
  for (const TablePosition& entry_index : entry_indices) {
    EntryRuns& own = out.emplace_back();
    const auto found = table.numbers.find(entry_index);
    if (found == table.numbers.end()) continue;
    own.finished = found->second.finished();
    own.tried = table.tried.at(entry_index);
    const auto add = [&](const auto& losses, const auto& key) {
      if (const auto lost = losses.find(key); lost != losses.end()) {
        own.tried.insert(lost->second.begin(), lost->second.end());
      }
    };
    if (along_columns) add(table.lost_by_row, entry_index.first);
    if (!along_columns) add(table.lost_by_method, found->second.method());
  }
  return out;
}

}  // namespace

std::vector<TablePosition> entry_indices(const TableNumbers& table,
                                         std::size_t index,
                                         bool along_columns) {
  const std::size_t entries = (along_columns ? table.rows : table.columns).names().size();
  std::vector<TablePosition> out;
  for (std::size_t i = 0; i < entries; ++i) {
    out.push_back(along_columns ? TablePosition{i, index} : TablePosition{index, i});
  }
  return out;
}

MarkInput mark_input(const TableNumbers& table,
                     const std::vector<TablePosition>& entries,
                     bool along_columns) {
  MarkInput out{{}, table.groups, metrics::Better::neither, 0.0};
  std::set<std::string> runs;
  for (const TablePosition& entry_index : entries) {
    ByRun& own = out.competitors.emplace_back();
    const auto found = table.numbers.find(entry_index);
    if (found == table.numbers.end() || found->second.runs().empty()) continue;
    own = found->second.runs();
    out.better = found->second.better();
    out.target = found->second.target();
    for (const auto& [run, value] : own) runs.insert(run);
  }
  const auto lose = [&](ByRun& own, const auto& losses, const auto& key) {
    const auto found = losses.find(key);
    if (own.empty() || found == losses.end()) return;
    for (const std::string& run : found->second) {
      if (runs.contains(run)) own.emplace(run, std::nullopt);
    }
  };
  for (std::size_t i = 0; i < entries.size(); ++i) {
    ByRun& own = out.competitors[i];
    if (own.empty()) continue;
    lose(own, table.lost, entries[i]);
    if (along_columns) lose(own, table.lost_by_row, entries[i].first);
    if (!along_columns) lose(own, table.lost_by_method, table.numbers.at(entries[i]).method());
  }
  return out;
}

std::string keep_common_runs(TableNumbers& table, bool along_columns) {
  const std::vector<std::string> names = (along_columns ? table.columns : table.rows).names();
  CommonRunsNote note;
  for (std::size_t l = 0; l < names.size(); ++l) {
    const std::vector<TablePosition> lane_places = entry_indices(table, l, along_columns);
    const std::vector<EntryRuns> entries = entry_runs(table, lane_places, along_columns);
    const auto common = common_runs(entries);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (entries[i].finished == common[i]) continue;
      note.add(names[l], common[i].size());
      table.numbers.at(lane_places[i]).keep(common[i]);
    }
  }
  return note.text();
}

std::size_t possible(const MarkInput& input, std::size_t i) {
  std::set<std::string> out;
  for (const ByRun& other : input.competitors) {
    const bool shares = std::ranges::any_of(
        other, [&](const auto& run) { return input.competitors[i].contains(run.first); });
    if (!shares) continue;
    for (const auto& [run, value] : other) out.insert(run);
  }
  return out.size();
}

std::size_t number_of_runs(const MarkInput& input) {
  std::set<std::string_view> out;
  for (const ByRun& own : input.competitors) {
    for (const auto& [run, value] : own) out.insert(run);
  }
  return out.size();
}

}  // namespace loopbench::harness
