/// Reads the trajectory files of `eval` and evaluates every estimate under every protocol.
#pragma once

#include <vector>

#include "harness/eval/arguments.hpp"
#include "harness/eval/evaluation_result.hpp"

namespace loopbench::harness {

/// Returns one result for each estimate and protocol, in that order. If there are several, an
/// estimate that cannot be read or evaluated has a result with `why_failed`. Throws InputError,
/// OptionError.
std::vector<EvaluationResult> evaluate_files(const EvalArguments& arguments);

}  // namespace loopbench::harness
