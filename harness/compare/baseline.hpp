/// Reviewed numbers of a sweep: the reference of `loopbench check`.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/model/record.hpp"

namespace loopbench::harness {

/// Limit on the change of a number: it is a regression if worse by more than absolute + relative *
/// |baseline|. With `alpha`, consistent small losses over all runs of a method are a regression,
/// too, even if each number is within the limit (see consistent_loss.hpp). Scores without a
/// direction are limited in both directions.
struct Tolerance {
  std::vector<std::string> where;                  ///< filters, see model/where; empty: every score
  std::vector<std::string> values{"rmse", "max"};  ///< compared statistics
  double relative = 0.001;                         ///< [-]
  double absolute = 1e-6;                          ///< in the unit of the score
  double tie = 1e-6;  ///< relative change that counts as a tie in the test [-]
  std::optional<double> alpha = 0.01;
};

/// Limit for times: a cell's median wall time [ms], compared between runs on the same CPU, with a
/// test for methods that are slower by a tenth or more.
Tolerance time_limit(double relative);

/// Whether a limit is about times (its `where` has metric=time); otherwise times are not checked.
bool limits_time(const std::vector<Tolerance>& limits);

/// One score of one cell with the statistics that have a limit.
struct GateScore : Record {
  std::int64_t count = 0;                ///< errors behind the statistics, for example RPE pairs
  std::map<std::string, double> values;  ///< by statistic; empty if the status has no number
};

/// The record of a cell without its scores, and these.
struct GateCell : Record {
  std::vector<GateScore> scores;
};

/// The numbers of one sweep, with the definitions of its labels.
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
  std::map<std::string, std::string>
      build_summary;                           ///< version, compiler, commit, source clean or dirty
  std::vector<Tolerance> limits{Tolerance{}};  ///< the first whose `where` matches a score applies
  Snapshot snapshot;
};

/// Whether some of its cells were computed by a build with uncommitted changes.
bool is_dirty(const std::map<std::string, std::string>& build_summary);

/// "room (repeat 2) / uniform".
std::string name(const GateCell& cell);

/// "ate translation 3d, dense, loopbench".
std::string name(const GateScore& score);

/// The cells of a store's records (without derived ones), with the statistics in `limits`. Throws
/// InputError for an unknown statistic. O(n log n).
std::vector<GateCell> gate_cells(const std::vector<Record>& records,
                                 const std::vector<Tolerance>& limits);

}  // namespace loopbench::harness
