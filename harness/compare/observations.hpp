/// The values of one score, method by run: what comparisons are made on.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/store/record.hpp"

namespace loopbench {

/// What one observation is.
enum class Over {
  runs,      ///< each repeat of each sequence: conclusions hold for these sequences
  sequences  ///< the mean over a sequence's repeats: conclusions reach to sequences like these
};

/// "room" or "room (repeat 2)": the run of a record.
std::string run_name(const Record& record);

struct Observations {
  Record kind;  ///< protocol, times, metric, relation, axis and unit, shared by all values
  std::vector<std::string> methods;
  std::vector<std::string> runs;                           ///< "room" or "room (repeat 2)"
  std::vector<std::string> sequences;                      ///< of each run
  std::vector<std::vector<std::optional<double>>> values;  ///< [method][run]
  std::vector<std::vector<std::string>> status;  ///< why there is no value; "" where one is
};

/// One table for every score (protocol, times, metric, relation, axis) in the records, in the order
/// they appear; only numbers with status ok count. A run or a method that any record names is in
/// every table, with the status of its cell, or "not run". Throws InputError for an unknown
/// statistic. O(n log n).
std::vector<Observations> observations(const std::vector<Record>& records,
                                       const std::string& value);

/// Means over the repeats of each sequence: geometric where all of them are positive. A method
/// without a value on one repeat has none on the sequence.
Observations by_sequence(const Observations& by_run);

}  // namespace loopbench
