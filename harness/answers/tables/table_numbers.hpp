/// Numbers of a table before averaging.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "harness/answers/compare/compare.hpp"
#include "harness/answers/tables/reasons.hpp"
#include "harness/answers/tables/table.hpp"
#include "harness/sweep/model/name_order.hpp"
#include "harness/sweep/model/record.hpp"
#include "harness/sweep/model/sweep.hpp"

namespace loopbench::harness {

using RunSet = std::set<std::size_t>;  ///< numbers of runs

/// What one entry of a table averages.
struct TableEntry {
  struct Value {
    std::size_t run = 0;
    std::size_t group = 0;
    SharedText method;
    SharedText sequence;
    double value = 0.0;
    bool is_kept = true;  ///< averaged
  };

  std::vector<Value> values = {};
  std::string status = {};      ///< of a record that has no value
  Shared<ScoreKind> kind = {};  ///< of a record
  /// Of the score `gain` -1, of `change` 1: values are 100 * sign * (ratio to the baseline - 1).
  int ratio_sign = 0;
  bool is_oracle = false;
  bool is_stated = false;  ///< has times that programs state
  bool is_gap = false;     ///< a gap of the metric optimality
  RunSet tried = {};       ///< runs with a score of any status
  RunSet lost = {};        ///< runs on which a score failed
  /// Number of runs without a number on which a compared entry has one, or failed.
  std::size_t missing = 0;

  /// The values that are averaged.
  std::vector<double> kept() const;
  /// Whether its sequences have different numbers of averaged values.
  bool is_uneven() const;
  bool is_ratio() const { return ratio_sign != 0; }
  /// The mean, in which each sequence counts once; for gains and changes that of the geometric mean
  /// ratio, over groups. nullopt if that is not a number.
  std::optional<double> average() const;
  /// Number of values of equal weight whose mean is as certain: 1 / sum of the squared weights. It
  /// is that of the averaged values, unless each sequence counts once and they have different
  /// numbers.
  double effective() const;
  /// Sample standard deviation of the averaged values, with their weights in the mean; nullopt for
  /// fewer than two.
  std::optional<double> deviation() const;

 private:
  /// Of the averaged values in the mean, in their order; their sum is 1.
  std::vector<double> weights() const;
};

struct PlacedRecord {
  const Record* record = nullptr;
  std::size_t row = 0;
  std::optional<std::size_t> column = {};  ///< none without a score
};

/// Contents of a table under construction.
struct TableNumbers {
  void note(const TableNote& line) {
    if (std::ranges::count(notes, line) == 0) notes.push_back(line);
  }

  NameOrder rows;
  NameOrder columns;
  std::vector<std::string> units;  // of the columns
  NameOrder runs;
  NameOrder groups;
  std::vector<std::size_t> group_of_run;
  std::vector<PlacedRecord> records;
  std::vector<std::vector<TableEntry>> entries;  // [row][column]; missing at the ends: no record
  std::map<std::size_t, RunSet> lost_by_row;     // runs without any score
  std::map<SharedText, RunSet> lost_by_method;
  /// Smallest and largest number of errors behind the values of a column, if it differs from the
  /// evaluated poses: a relative error has fewer pairs, a closure residual one error per closure.
  std::map<std::size_t, std::pair<std::size_t, std::size_t>> error_counts;
  std::map<std::size_t, std::string> row_status;  // status of runs without any score
  std::set<std::string> oracle_sequences;  // closures measured in or selected by the reference
  std::vector<Missing> missing;
  std::vector<TableNote> notes;
};

/// The texts of the fields that are not empty.
std::string fields_joined(const Record& record,
                          const std::vector<std::string>& names,
                          const char* glue);

/// Restricts means to runs that all entries compared with them finished, and counts the missing
/// runs. Returns the note about it; empty if all entries finished the same runs.
std::string keep_common_runs(TableNumbers& table, bool along_columns);

/// Marks the methods that are best among the records of each column (or row) of the finished table
/// `out`, with the test of `compare` for any baseline, corrected for the number of columns (or
/// rows), and adds a note about it or the reason why none is marked. No mark for a column with
/// several scores, with several entries of a method, or with a smaller mean than that of the best.
void mark_best(Table& out, const TableNumbers& table, const TableSpec& spec, bool along_columns);

}  // namespace loopbench::harness
