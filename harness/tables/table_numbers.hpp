/// Numbers of a table before averaging, and the comparisons between its entries.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "datasets/hash.hpp"
#include "harness/model/sweep.hpp"
#include "harness/model/text_index.hpp"
#include "harness/tables/by_run.hpp"
#include "harness/tables/entry_numbers.hpp"
#include "harness/tables/error_counts.hpp"
#include "harness/tables/mark_best.hpp"
#include "harness/tables/notes.hpp"

namespace loopbench::harness {

using TablePosition = std::pair<std::size_t, std::size_t>;  // row, column

struct TablePositionHash {
  std::size_t operator()(const TablePosition& position) const {
    return mixed(position.first, position.second);
  }
};

/// Contents of one entry under construction.
struct EntryContents {
  EntryNumbers numbers = {};
  std::string status = {};  ///< of a record that has no value
  std::size_t kind = 0;     ///< number of its texts in TableNumbers::kinds
  RunSet tried = {};        ///< runs with a score of any status
  RunSet lost = {};         ///< runs on which a score failed
};

/// Contents of a table under construction.
struct TableNumbers {
  explicit TableNumbers(const TableSpec& spec);

  /// nullptr if it has no record.
  const EntryContents* find(const TablePosition& position) const {
    const auto found = entries.find(position);
    return found == entries.end() ? nullptr : &found->second;
  }

  void note(const std::string& text) {
    if (std::ranges::count(notes, text) == 0) notes.push_back(text);
  }

  TextIndex rows;
  TextIndex columns;
  TextIndex kinds;
  TextIndex runs;
  TextIndex groups;
  std::vector<std::size_t> group_of_run;
  std::unordered_map<TablePosition, EntryContents, TablePositionHash> entries;
  std::map<std::size_t, RunSet> lost_by_row;  // runs without any score
  std::map<SharedText, RunSet> lost_by_method;
  ErrorCounts counts;
  std::map<std::size_t, std::string> row_status;  // status of runs without any score
  std::set<std::string> oracle_sequences;  // closures measured in or selected by the reference
  std::vector<Missing> missing;
  std::vector<std::string> notes;
};

/// The texts of the fields that are not empty.
std::string fields_joined(const Record& record,
                          const std::vector<std::string>& names,
                          const char* glue);

/// The entries of one column (or row).
std::vector<TablePosition> entry_indices(const TableNumbers& table,
                                         std::size_t index,
                                         bool along_columns);

/// The entries of a column (or a row) that compete, with the runs on which they failed.
MarkInput mark_input(const TableNumbers& table,
                     const std::vector<TablePosition>& entries,
                     bool along_columns);

/// Restricts means to runs that all entries compared with them finished. Returns the note about it;
/// empty if all entries finished the same runs.
std::string keep_common_runs(TableNumbers& table, bool along_columns);

/// Maximum number of runs for the mean of competitor `i`: those of all competitors that have a run
/// in common with it.
std::size_t possible(const MarkInput& input, std::size_t i);

}  // namespace loopbench::harness
