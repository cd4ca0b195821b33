/// Conversion of a long table to rows x columns, one table per combination of the split columns.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/model/sweep.hpp"
#include "harness/tables/mark_best.hpp"

namespace loopbench::harness {

/// Status of an entry without a run that all entries compared with it have finished.
inline constexpr const char* kNoCommonRun = "no common run";

inline constexpr const char* kEmptyTable = "the table is empty: no rows to show";

/// One entry of a table: the mean over its records. If the entries of several methods finished
/// different runs, the mean is over the runs that all of them finished.
struct TableEntry {
  std::optional<double> value = {};
  std::optional<double> deviation =
      {};                    ///< sample standard deviation; set by TableSpec::plus_minus
  std::size_t records = 0;   ///< records with a number (repeats, for example)
  std::size_t averaged = 0;  ///< of these, those on runs that all compared entries finished
  std::string status = {};   ///< "declined", "failed", "no common run", ... if there is no value
  Mark mark = Mark::none;    ///< significantly best or second best of its column or row
  std::size_t possible = 0;  ///< records including failed and missing ones; 0: none is missing
};

struct Table {
  std::string title;                 ///< values of the split columns
  std::string corner;                ///< names of the row columns
  std::vector<std::string> columns;  ///< with unit
  std::vector<std::string> rows;
  std::vector<std::vector<TableEntry>> entries;  ///< [row][column]
  std::vector<std::string> notes;                ///< reasons for missing values, oracle flags
};

/// If the rows are methods, marks the best value of each column (see mark_best.hpp); if the columns
/// are methods, that of each row. Entries with fewer runs than others state their number; means are
/// then over common runs (common_runs.hpp), and a note reports it. Gains are averaged as geometric
/// means of the ratios. Several protocols always result in separate tables. Rows, columns and
/// tables are in order of first appearance in the records. Throws InputError for an unknown column
/// or statistic, and if an entry would average different scores (rotation with translation,
/// keyframes with dense). O(n log n).
std::vector<Table> pivot(const std::vector<Record>& records,
                         const TableSpec& spec,
                         const RankingOptions& options = {});

/// The tables of some of the records, for records that are not in memory at once.
struct PivotedTables {
  std::vector<Table> tables;
  std::size_t with_scores = 0;  ///< the first tables; the others have only cells without a score
};

/// The tables of complete sequences, if `spec` splits by sequence. Several protocols must be
/// separated by `spec`. Does not throw if there is none.
PivotedTables pivot_parts(const std::vector<Record>& records,
                          const TableSpec& spec,
                          const RankingOptions& options);

/// Whether rows, columns or split contain one of the fields.
bool separates(const TableSpec& spec, std::initializer_list<const char*> any_of);

}  // namespace loopbench::harness
