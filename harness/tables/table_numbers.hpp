/// Numbers of a table before averaging, and the comparisons between its entries.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "harness/compare/name_order.hpp"
#include "harness/tables/entry_numbers.hpp"
#include "harness/tables/error_counts.hpp"
#include "harness/tables/mark_best.hpp"
#include "harness/tables/notes.hpp"

namespace loopbench::harness {

using TablePosition = std::pair<std::size_t, std::size_t>;  // row, column

/// Contents of a table under construction.
struct TableNumbers {
  NameOrder rows;
  NameOrder columns;
  std::map<TablePosition, EntryNumbers> numbers;
  std::map<TablePosition, std::string> status;  // of entries with a record that has no value
  std::map<TablePosition, std::string> kinds;
  std::map<TablePosition, std::set<std::string>> tried;      // runs with a score of any status
  std::map<TablePosition, std::set<std::string>> lost;       // runs on which a score failed
  std::map<std::size_t, std::set<std::string>> lost_by_row;  // runs without any score
  std::map<std::string, std::set<std::string>> lost_by_method;
  std::map<std::string, std::string> groups;  // of runs
  ErrorCounts counts;
  std::map<std::size_t, std::string> row_status;  // status of runs without any score
  std::set<std::string> oracle_sequences;  // closures measured in or selected by the reference
  std::vector<Missing> missing;
  std::vector<std::string> notes;

  void note(const std::string& text) {
    if (std::ranges::count(notes, text) == 0) notes.push_back(text);
  }
};

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

/// Number of runs of all competitors together: an upper limit of possible().
std::size_t number_of_runs(const MarkInput& input);

}  // namespace loopbench::harness
