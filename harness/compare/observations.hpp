/// The values of one score, method by run: what comparisons are made on.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/model/record.hpp"

namespace loopbench {

/// "room" or "room (repeat 2)": the run of a record.
std::string run_name(const Record& record);

/// Runs with the same name belong to one group: Record::group, or the run by itself.
std::string group_name(const Record& record);

/// Whether a record without a usable value is a loss of its method: the method failed, crashed, ran
/// out of its limits, declined, or left an estimate that is incomplete or has no score. A score
/// that is undefined or declined is the metric's own.
bool is_loss(const Record& record);

/// One value, or why there is none.
struct Observed {
  std::optional<double> value;
  bool is_loss = false;
  std::string status = "not run";  ///< "" with a value
};

struct ObservedRun {
  std::string name;  ///< "room" or "room (repeat 2)"
  std::string sequence;
  std::string group;
  std::string content;  ///< runs of equal non-empty content are one observation
  bool has_oracle_closures = false;
};

struct Observations {
  Record kind;  ///< protocol, times, metric, relation, axis and unit, shared by all values
  std::vector<std::string> methods;
  std::vector<ObservedRun> runs;
  std::vector<std::vector<Observed>> values;  ///< [method][run]
};

/// One table for every score (protocol, times, metric, relation, axis) in the records, in the order
/// they appear; only finite numbers with status ok count. A run or a method that any record names
/// is in every table. Throws InputError for an unknown statistic. O(n log n).
std::vector<Observations> observations(const std::vector<Record>& records,
                                       const std::string& value);

/// Keeps the first of every set of runs with equal content; a method that loses one of them loses
/// it. Returns the number of runs that were dropped.
std::size_t drop_copies(Observations& all);

}  // namespace loopbench
