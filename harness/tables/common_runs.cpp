#include <algorithm>
#include <map>
#include <set>

#include "harness/tables/table_numbers.hpp"

namespace loopbench::harness {
namespace {

/// One entry of a column (or a row) of a table.
struct EntryRuns {
  RunSet tried;     ///< runs with any outcome
  RunSet finished;  ///< runs with a number; subset of `tried`
};

/// Runs that the entries of a column (or a row) tried and finished.
std::vector<EntryRuns> entry_runs(const TableNumbers& table,
                                  const std::vector<TablePosition>& positions,
                                  bool along_columns) {
  std::vector<EntryRuns> out;
  for (const TablePosition& position : positions) {
    EntryRuns& own = out.emplace_back();
    const EntryContents* entry = table.find(position);
    if (entry == nullptr || entry->numbers.size() == 0) continue;
    own.finished = entry->numbers.finished();
    own.tried = entry->tried;
    const auto add = [&](const auto& losses, const auto& key) {
      if (const auto lost = losses.find(key); lost != losses.end())
        own.tried.insert(lost->second.begin(), lost->second.end());
    };
    if (along_columns) add(table.lost_by_row, position.first);
    if (!along_columns) add(table.lost_by_method, entry->numbers.method());
  }
  return out;
}

bool intersect(const RunSet& a, const RunSet& b) {
  return std::ranges::any_of(a, [&](std::size_t run) { return b.contains(run); });
}

/// Returns for each entry the runs that all entries compared with it have finished. Two entries are
/// compared if both finished at least one run and tried a common run, directly or through other
/// entries. A method that fails everywhere and entries of other sequences therefore do not restrict
/// the runs. O(entries^2 * runs).
std::vector<RunSet> common_runs(const std::vector<EntryRuns>& entries) {
  std::vector<RunSet> out(entries.size());
  std::vector<bool> is_done(entries.size());
  for (std::size_t first = 0; first < entries.size(); ++first) {
    if (is_done[first] || entries[first].finished.empty()) continue;
    std::vector<std::size_t> compared{first};
    is_done[first] = true;
    RunSet common = entries[first].finished;
    for (std::size_t i = 0; i < compared.size(); ++i) {
      for (std::size_t other = 0; other < entries.size(); ++other) {
        if (is_done[other] || entries[other].finished.empty()) continue;
        if (!intersect(entries[compared[i]].tried, entries[other].tried)) continue;
        compared.push_back(other);
        is_done[other] = true;
        keep_only(common, entries[other].finished);
      }
    }
    for (const std::size_t i : compared) out[i] = common;
  }
  return out;
}

std::string runs_text(const std::set<std::size_t>& runs) {
  std::string out;
  for (const std::size_t count : runs) {
    out += (out.empty() ? "" : " or ") + (count == 0 ? "none (-)" : std::to_string(count));
  }
  return out;
}

/// "means over the 4 runs that every method finished", for the numbers of runs of the means in each
/// column (or row); empty without any.
std::string common_runs_note(const std::map<std::string, std::set<std::size_t>>& counts) {
  if (counts.empty()) return "";
  const std::set<std::size_t>& first = counts.begin()->second;
  const bool is_one = std::ranges::all_of(
      counts, [&](const auto& entry) { return first.size() == 1 && entry.second == first; });
  if (is_one && first.contains(0)) return "no means (-): no run was finished by every method";
  if (is_one) {
    return "means over the " + std::to_string(*first.begin()) +
           (first.contains(1) ? " run" : " runs") + " that every method finished";
  }
  std::string out;
  for (const auto& [name, runs] : counts) {
    out += (out.empty() ? "" : ", ") + name + ": " + runs_text(runs);
  }
  return "means over the runs that every method finished (" + out + ")";
}

}  // namespace

std::string keep_common_runs(TableNumbers& table, bool along_columns) {
  const std::vector<std::string>& names = (along_columns ? table.columns : table.rows).names();
  std::map<std::string, std::set<std::size_t>> counts;
  for (std::size_t l = 0; l < names.size(); ++l) {
    const std::vector<TablePosition> positions = entry_indices(table, l, along_columns);
    const std::vector<EntryRuns> entries = entry_runs(table, positions, along_columns);
    const std::vector<RunSet> common = common_runs(entries);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (entries[i].finished == common[i]) continue;
      counts[names[l]].insert(common[i].size());
      table.entries.at(positions[i]).numbers.keep(common[i]);
    }
  }
  return common_runs_note(counts);
}

}  // namespace loopbench::harness
