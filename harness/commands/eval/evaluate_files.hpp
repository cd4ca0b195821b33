/// Evaluation of every estimate under every protocol, of trajectories in files or in memory: a
/// sweep with one cell for each estimate, computed in this process and written to a store.
#pragma once

#include <string>
#include <vector>

#include "harness/commands/eval/arguments.hpp"
#include "harness/commands/eval/file_evaluation.hpp"
#include "harness/sweep/run/build.hpp"

namespace loopbench::harness {

struct Evaluations {
  std::vector<EvaluationResult> results;  ///< for each estimate and protocol; none with --store
  std::vector<Record> records;            ///< of the store; without --store, by estimate
  std::vector<EvaluatedRun> runs;         ///< of the store
  std::string summary = {};               ///< see StoreSummary::text(); empty without --store
  std::vector<std::string> notes = {};    ///< with --store: on earlier runs, and of those evaluated
  bool are_ok = true;                     ///< with --store: see StoreSummary::is_ok()
};

/// Also writes the page of --report. Without --store, the store is in memory until then. If there
/// are several estimates or protocols, an estimate that cannot be read or evaluated has a result
/// with `why_failed`; without --min-coverage, an estimate is incomplete that covers less than a
/// tenth of its reference or less than half of what another one covers.
///
/// FOLDER/results.sqlite of --store is like the store of a sweep: systems are methods, their runs
/// are repeats. Runs that it already has are kept; unchanged files are not evaluated again, except
/// those that failed. Every run of a sequence is a group of its own, so that conclusions hold for
/// other runs on these sequences; runs with the same number on equal references are one group, see
/// set_evaluated_group(). Throws InputError, OptionError; the store is then unchanged if it is the
/// result of a sweep or a reference cannot be read. O(poses).
Evaluations evaluate_files(const EvalArguments& arguments, const Source& source = {});

/// The same for two trajectories in memory; the reference is in the body of the estimate. Throws
/// InputError if the evaluation fails.
Evaluations evaluate_in_memory(const EvalArguments& arguments,
                               EvaluatedFile reference,
                               const EvaluatedFile& estimate);

}  // namespace loopbench::harness
