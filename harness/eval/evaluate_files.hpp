/// Evaluation of every estimate under every protocol, of trajectories in files or in memory: a
/// sweep with one cell for each estimate, computed in this process.
#pragma once

#include <functional>
#include <vector>

#include "harness/eval/arguments.hpp"
#include "harness/eval/recorded_evaluation.hpp"

namespace loopbench::harness {

/// Returns one result for each estimate and protocol, in that order. If there are several, an
/// estimate that cannot be read or evaluated has a result with `why_failed`; without
/// --min-coverage, an estimate is incomplete that covers less than a tenth of its reference or less
/// than half of what another one covers. Throws InputError, OptionError.
/// `visit` gets the sweep and the evaluations before their conversion.
std::vector<EvaluationResult> evaluate_files(
    const EvalArguments& arguments,
    const std::function<void(const RecordedSweep&, const std::vector<EvaluatedFile>&)>& visit = {});

/// The same for two trajectories in memory; the reference is in the body of the estimate. Throws
/// InputError if the evaluation fails.
std::vector<EvaluationResult> evaluate_in_memory(const EvalArguments& arguments,
                                                 RecordedFile reference,
                                                 const RecordedFile& estimate);

}  // namespace loopbench::harness
