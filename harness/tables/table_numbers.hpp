/// Numbers of a table before averaging.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "datasets/core/hash.hpp"
#include "harness/model/name_order.hpp"
#include "harness/model/record.hpp"
#include "harness/tables/notes.hpp"

namespace loopbench::harness {

using RunSet = std::set<std::size_t>;  ///< numbers of runs

/// Key of a run within an entry: the content of its data if known, otherwise its name.
std::string run_key(const Record& record);

/// The numbers that are aggregated in one entry of a table.
class EntryNumbers {
 public:
  /// `run` and `group`: numbers of run_key() and group_name(). Throws InputError for an unknown
  /// statistic.
  void add(const Record& record, std::size_t run, std::size_t group, const std::string& statistic);

  /// Number of added records.
  std::size_t size() const { return values_.size(); }
  /// Number of averaged records: added and kept.
  std::size_t averaged() const;
  /// The runs of the averaged records.
  RunSet finished() const;
  /// Restricts the average to the records of these runs.
  void keep(const RunSet& runs);

  /// The mean; for gains 1 - the geometric mean ratio, over groups as in a verdict. nullopt if that
  /// is not a number.
  std::optional<double> average() const;
  /// Sample standard deviation of the averaged values; nullopt for fewer than two.
  std::optional<double> deviation() const;

  const SharedText& method() const { return method_; }
  bool is_oracle() const { return is_oracle_; }
  bool is_gain() const { return is_gain_; }

 private:
  struct Value {
    std::size_t run = 0;
    std::size_t group = 0;
    SharedText method;
    double value = 0.0;
    bool is_kept = true;
  };

  double gain() const;
  std::vector<double> kept() const;

  std::vector<Value> values_;
  SharedText method_;
  bool is_gain_ = false;
  bool is_oracle_ = false;
};

using TablePosition = std::pair<std::size_t, std::size_t>;  // row, column

struct TablePositionHash {
  std::size_t operator()(const TablePosition& position) const {
    return hash_combine(position.first, position.second);
  }
};

/// Contents of one entry under construction.
struct EntryContents {
  EntryNumbers numbers = {};
  std::string status = {};  ///< of a record that has no value
  std::size_t kind = 0;     ///< number of its texts in TableNumbers::kinds
  bool is_stated = false;   ///< has times that programs state
  bool is_gap = false;      ///< a gap of the metric optimality
  RunSet tried = {};        ///< runs with a score of any status
  RunSet lost = {};         ///< runs on which a score failed
  /// Number of runs without a number on which a compared entry has one, or failed.
  std::size_t missing = 0;
};

struct PlacedRecord {
  const Record* record = nullptr;
  std::size_t row = 0;
  std::optional<std::size_t> column = {};  ///< none without a score
};

/// Contents of a table under construction.
struct TableNumbers {
  /// nullptr if it has no record.
  const EntryContents* find(const TablePosition& position) const {
    const auto found = entries.find(position);
    return found == entries.end() ? nullptr : &found->second;
  }

  void note(const std::string& text) {
    if (std::ranges::count(notes, text) == 0) notes.push_back(text);
  }

  NameOrder rows;
  NameOrder columns;
  NameOrder kinds;
  NameOrder runs;
  NameOrder groups;
  std::vector<std::size_t> group_of_run;
  std::vector<PlacedRecord> records;
  std::unordered_map<TablePosition, EntryContents, TablePositionHash> entries;
  std::map<std::size_t, RunSet> lost_by_row;  // runs without any score
  std::map<SharedText, RunSet> lost_by_method;
  /// Smallest and largest number of errors behind the values of a column, if it differs from the
  /// evaluated poses: a relative error has fewer pairs, a closure residual one error per closure.
  std::map<std::size_t, std::pair<std::size_t, std::size_t>> error_counts;
  std::map<std::size_t, std::string> row_status;  // status of runs without any score
  std::set<std::string> oracle_sequences;  // closures measured in or selected by the reference
  std::vector<Missing> missing;
  std::vector<std::string> notes;
};

/// The texts of the fields that are not empty.
std::string fields_joined(const Record& record,
                          const std::vector<std::string>& names,
                          const char* glue);

/// Restricts means to runs that all entries compared with them finished, and counts the missing
/// runs. Returns the note about it; empty if all entries finished the same runs.
std::string keep_common_runs(TableNumbers& table, bool along_columns);

}  // namespace loopbench::harness
