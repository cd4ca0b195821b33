/// Evaluation of every estimate under every protocol, of trajectories in files or in memory: a
/// sweep with one cell for each estimate, computed in this process.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "harness/eval/arguments.hpp"
#include "harness/eval/recorded_evaluation.hpp"
#include "harness/run/build.hpp"

namespace loopbench::harness {

struct Evaluations {
  std::vector<EvaluationResult> results;  ///< for each estimate and protocol, in that order
  std::vector<Record> records;            ///< all, by estimate
  std::vector<RecordedRun> runs;          ///< the estimates
};

/// If there are several estimates or protocols, an estimate that cannot be read or evaluated has a
/// result with `why_failed`; without --min-coverage, an estimate is incomplete that covers less
/// than a tenth of its reference or less than half of what another one covers. Throws InputError,
/// OptionError. `visit` gets a store of the results, which exists only during the visit.
Evaluations evaluate_files(const EvalArguments& arguments,
                           const Source& source = {},
                           const std::function<void(const std::filesystem::path&)>& visit = {});

/// The same for two trajectories in memory; the reference is in the body of the estimate. Throws
/// InputError if the evaluation fails.
Evaluations evaluate_in_memory(const EvalArguments& arguments,
                               RecordedFile reference,
                               const RecordedFile& estimate);

}  // namespace loopbench::harness
