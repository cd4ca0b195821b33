/// What a sweep's numbers were when somebody looked at them: the reference of `loopbench check`.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/store/record.hpp"

namespace loopbench {

/// How far a number may move before it is a regression. One that is worse by more than absolute +
/// relative * |baseline| is. With `alpha`, so is a method that is worse over all its runs by a
/// one-sided paired Wilcoxon test (Holm over methods and scores), each number within the limits or
/// not. Scores that have no better and worse may move neither way.
struct Tolerance {
  std::vector<std::string> where;  ///< rules, see export/where; empty: every score
  std::string value = "rmse";      ///< statistic that is compared
  double relative = 0.001;         ///< [-]
  double absolute = 1e-6;          ///< in the unit of the score
  double tie = 1e-6;               ///< relative move that no test takes for one [-]
  std::optional<double> alpha = 0.01;
};

/// The limit that makes the gate look at times too: of a cell's median wall time [ms], between runs
/// on the same CPU, with a test for methods that got slower by a tenth or more.
Tolerance time_limit(double relative);

/// Whether one of them is about times (its `where` says metric=time): time is not gated otherwise.
bool limits_time(const std::vector<Tolerance>& limits);

/// One score of one cell: what was asked, and the statistics that some limit is about.
struct GateScore {
  std::string protocol;
  std::string times;
  std::string metric;
  std::string relation;
  std::string axis;
  std::string unit;
  std::string status = "ok";
  std::int64_t pairs = 0;                ///< pose pairs judged: fewer is a regression
  std::map<std::string, double> values;  ///< by statistic; empty unless the status is ok
  Better better = Better::lower;
};

struct GateCell {
  std::string sequence;
  std::int64_t repeat = 0;
  std::string method;
  std::string status = "ok";
  std::vector<GateScore> scores;
};

/// The numbers of one sweep, and what they were made from.
struct Snapshot {
  std::string sweep;
  std::map<std::string, std::string> sequences;  ///< label -> all options, hashes of files
  std::map<std::string, std::string> protocols;  ///< label and version -> every rule
  std::vector<GateCell> cells;
};

struct Baseline {
  std::map<std::string, std::string> made_by;  ///< for people: version, compiler, commit
  std::vector<Tolerance> limits{Tolerance{}};  ///< the first whose `where` keeps a score holds
  Snapshot snapshot;
};

/// "room (repeat 2) / uniform".
std::string name(const GateCell& cell);

/// "ate translation 3d, dense, loopbench".
std::string name(const GateScore& score);

/// What `where` looks at.
Record as_record(const GateCell& cell, const GateScore& score);

/// The cells of a store's records (without derived ones), with the statistics that `limits` name.
/// Throws InputError for an unknown statistic. O(n log n).
std::vector<GateCell> gate_cells(const std::vector<Record>& records,
                                 const std::vector<Tolerance>& limits);

}  // namespace loopbench
