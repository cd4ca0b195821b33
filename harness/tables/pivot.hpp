/// A long table turned into rows x columns, one table per combination of the split columns.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/model/sweep.hpp"
#include "harness/tables/mark_best.hpp"

namespace loopbench::harness {

/// Status of a cell whose runs are not among those that every cell compared with it finished.
inline constexpr const char* kNoCommonRun = "no common run";

/// One cell of a table: the mean over the records that fell into it. Where cells of several methods
/// finished different runs, the mean is over the runs that all of them finished.
struct TableCell {
  std::optional<double> value = {};
  std::size_t records = 0;   ///< with a number (repeats, for example)
  std::size_t averaged = 0;  ///< of them: on runs that all compared cells finished
  std::string status = {};   ///< "declined", "failed", "no common run", ... when there is no value
  Mark mark = Mark::none;    ///< best or second best of its column or row, where that is proven
  std::size_t possible = 0;  ///< records and those that failed or are missing; 0: none is missing
};

struct Table {
  std::string title;                 ///< values of the split columns
  std::string corner;                ///< names of the row columns
  std::vector<std::string> columns;  ///< with unit
  std::vector<std::string> rows;
  std::vector<std::vector<TableCell>> cells;  ///< [row][column]
  std::vector<std::string> notes;             ///< reasons of cells without value, oracle flags
};

/// Where the rows are methods, the best of a column is marked (see mark_best.hpp), where the
/// columns are, of a row, and cells with fewer runs than others state how many; their means are
/// over common runs (common_runs.hpp), which a note says. Gains are averaged as geometric means of
/// the ratios. Several protocols split the tables even when the spec does not name them. Rows,
/// columns and tables appear in the order in which the records first name them. Throws InputError
/// for an unknown column or statistic, and when a cell would average different scores (rotation
/// with translation, keyframes with dense). O(n log n).
std::vector<Table> pivot(const std::vector<Record>& records,
                         const TableSpec& spec,
                         const RankingOptions& options = {});

}  // namespace loopbench::harness
