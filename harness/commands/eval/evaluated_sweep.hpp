/// Estimate files as a sweep in memory: every run is a cell, systems are methods.
#pragma once

#include <string>
#include <vector>

#include "harness/commands/eval/arguments.hpp"
#include "harness/commands/eval/evaluated_runs.hpp"
#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/model/cells.hpp"
#include "harness/sweep/model/sweep.hpp"

namespace loopbench::harness {

/// Coverage below which a run in a store is a failure unless --min-coverage is given, 0..1.
inline constexpr double kDefaultMinCoverage = 0.5;

struct EvaluatedSweep {
  EvalArguments arguments;
  std::vector<EvaluatedRun> runs;
  ReferenceBody body;       ///< of the arguments
  Catalogue catalogue;      ///< dataset `files`, method `recorded`, all metrics
  Sweep sweep;              ///< a dataset for each run, with the sequence as label
  bool has_digits = false;  ///< a protocol computes with the digits of KITTI files

  /// One for each run, by sequence, run and method. The repeat is the position of the run's name
  /// among all runs of the sequence, numbers in names as numbers, so that runs of equal names are
  /// paired.
  std::vector<Cell> cells;
};

/// The methods are in the order of their first run. Throws InputError, OptionError.
EvaluatedSweep evaluated_sweep(std::vector<EvaluatedRun> runs, const EvalArguments& arguments);

/// The runs of the config text of a store; none for other texts. `merge` concatenates such texts:
/// of several runs with the same labels, the first is returned.
std::vector<EvaluatedRun> runs_of_manifest(const std::string& text);

}  // namespace loopbench::harness
