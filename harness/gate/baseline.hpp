/// The numbers of a sweep that somebody has looked at: the reference of `loopbench check`.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/model/record.hpp"

namespace loopbench {

/// How far a number may move before it is a regression: worse by more than absolute + relative *
/// |baseline|. With `alpha`, small losses that point the same way over all runs of a method are a
/// regression too, each number within the limit or not (see consistent_loss.hpp). Scores without a
/// direction may move neither way.
struct Tolerance {
  std::vector<std::string> where;                  ///< rules, see model/where; empty: every score
  std::vector<std::string> values{"rmse", "max"};  ///< statistics that are compared
  double relative = 0.001;                         ///< [-]
  double absolute = 1e-6;                          ///< in the unit of the score
  double tie = 1e-6;  ///< relative move that counts as none in a test [-]
  std::optional<double> alpha = 0.01;
};

/// The limit that makes the gate compare times too: of a cell's median wall time [ms], between runs
/// on the same CPU, with a test for methods that got slower by a tenth or more.
Tolerance time_limit(double relative);

/// Whether one of them is about times (its `where` has metric=time): time is not gated otherwise.
bool limits_time(const std::vector<Tolerance>& limits);

/// One score of one cell: which it is, and the statistics that some limit is about.
struct GateScore {
  std::string protocol;
  std::string times;
  std::string metric;  ///< catalogue name
  std::string label;   ///< of the metric in the config
  std::string relation;
  std::string axis;
  std::string unit;
  Better better = Better::lower;
  double target = 0.0;  ///< best value where `better` is target
  std::string status = "ok";
  std::int64_t pairs = 0;                ///< pose pairs judged
  std::int64_t possible = 0;             ///< pose pairs that could have been
  std::int64_t count = 0;                ///< errors behind the statistics, for example RPE pairs
  std::map<std::string, double> values;  ///< by statistic; empty where the status has no number
};

struct GateCell {
  std::string sequence;
  std::int64_t repeat = 0;
  std::string method;
  bool oracle = false;       ///< the method or its data was shown the reference
  bool oracle_data = false;  ///< its loop closures were measured in the reference
  std::string group;         ///< see Record::group
  std::string content;       ///< see Record::content
  std::string status = "ok";
  std::vector<GateScore> scores;
};

/// The numbers of one sweep, and the definitions they were made from.
struct Snapshot {
  std::string sweep;
  std::string machine;                           ///< compiler, C library and CPU of all cells
  std::map<std::string, std::string> sequences;  ///< label -> all options, hashes of files
  std::map<std::string, std::string> contents;   ///< label -> hash of problem and reference
  std::map<std::string, std::string> protocols;  ///< label and version -> every rule
  std::map<std::string, std::string> metrics;    ///< label -> name, all options
  std::map<std::string, std::string> methods;    ///< label -> stages, all options
  std::vector<GateCell> cells;
};

struct Baseline {
  std::map<std::string, std::string> made_by;  ///< version, compiler, commit, source clean or dirty
  std::vector<Tolerance> limits{Tolerance{}};  ///< the first whose `where` keeps a score holds
  Snapshot snapshot;
};

/// Whether some of its cells were computed by a build with uncommitted changes.
bool is_dirty(const std::map<std::string, std::string>& made_by);

/// Whether the status is that of a number: ok or incomplete.
bool has_number(const std::string& status);

/// "room (repeat 2)", "room (repeat 2) / uniform".
std::string sequence_name(const GateCell& cell);
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
