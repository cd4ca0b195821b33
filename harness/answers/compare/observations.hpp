/// The values of one score by method and run, input of a comparison.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "harness/sweep/model/name_order.hpp"
#include "harness/sweep/model/record.hpp"

namespace loopbench::harness {

/// Which run it is. Names of runs can be equal: a sequence can be labelled "room (repeat 1)".
std::string run_id(const CellRow& cell);

/// Runs with the same id belong to one group: CellRow::group, or otherwise the run itself.
std::string group_id(const CellRow& cell);

/// Whether a record without a usable value counts as a loss of its method: the method failed,
/// crashed, exceeded its limits, or its estimate is incomplete or has no score. A method or a score
/// that declines (no loops, no rotations) makes no claim, and is no observation.
bool is_loss(const Record& record);

inline const SharedText kNotRun = "not run";

/// One value, or the reason why there is none.
struct Observed {
  std::optional<double> value;
  bool is_loss = false;
  SharedText status = kNotRun;  ///< "" with a value
  double coverage = 1.0;        ///< the smaller share of possible pairs and of the time, 0..1
};

struct ObservedRun {
  std::string name;  ///< "room" or "room (repeat 2)"
  std::string sequence;
  std::string group;
  std::string recording;     ///< CellRow::recording
  bool is_of_files = false;  ///< independent of other runs of its recording
  std::string content;       ///< runs of equal non-empty content are one observation
  bool has_oracle_closures = false;
  bool is_fair = false;  ///< some method does not use the reference
};

struct Observations {
  ScoreKind kind;  ///< of all values, with unit and direction of the statistic; no direction if it
                   ///< or the target differs between values
  std::vector<std::string> methods;
  std::map<std::string, MethodParts> parts;  ///< of each method
  std::vector<ObservedRun> runs;
  std::vector<std::vector<Observed>> values;  ///< [method][run]
  std::vector<std::string> oracles;  ///< excluded: use the reference on a run where others do not
  std::set<std::string> unstable;    ///< methods that drop_duplicates() found to be random
  std::set<std::string> stated;      ///< methods of which some value is a time that they state
};

/// Collects the values of every kind of score, record by record.
class ObservationsBuilder {
 public:
  /// Throws InputError for an unknown statistic.
  explicit ObservationsBuilder(std::string statistic);

  /// O(1).
  void add(const Record& record);

  /// One table for each score in order of appearance; only finite numbers with status ok count.
  /// Every table contains all runs and methods but the oracles. Call once.
  std::vector<Observations> build();

 private:
  struct Unscored {
    std::size_t method = 0;
    std::size_t run = 0;
    Observed observed;
  };

  static void put(Observations& table, const Unscored& one);

  std::string value_;
  std::map<ScoreKind, std::size_t> kinds_;
  NameOrder methods_;
  std::vector<MethodParts> parts_;
  NameOrder run_ids_;
  std::vector<ObservedRun> runs_;
  std::vector<Observations> tables_;
  std::vector<Unscored> unscored_;  ///< records without a score, which count in every table
  std::set<std::pair<std::size_t, std::size_t>> oracle_runs_;  ///< method and run
};

/// The tables of these records. Throws InputError for an unknown statistic. O(n log n).
std::vector<Observations> observations(const std::vector<Record>& records,
                                       const std::string& value);

/// What runs of one sequence share: files of one recording under several names are one sequence.
std::string sequence_key(const ObservedRun& run);

/// Number of the group of each of these runs; with `by_sequence`, of its groups and sequences that
/// are connected.
std::vector<std::size_t> group_numbers(const Observations& all,
                                       const std::vector<std::size_t>& runs,
                                       bool by_sequence);

/// Keeps the first run of every set with equal content; a loss on one of them is a loss on the kept
/// run. Returns the number of dropped runs, and collects methods whose values on equal content
/// differ by more than a tie.
std::size_t drop_duplicates(Observations& all);

}  // namespace loopbench::harness
