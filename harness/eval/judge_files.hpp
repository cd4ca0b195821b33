/// Reads the files that `eval` names and judges every estimate under every protocol.
#pragma once

#include <vector>

#include "harness/eval/arguments.hpp"
#include "harness/eval/evaluation_result.hpp"

namespace loopbench::harness {

/// One for each estimate and protocol, in that order. Where there are several, what cannot be read
/// or judged is a EvaluationResult with `why_failed`. Throws InputError, OptionError.
std::vector<EvaluationResult> judge_files(const EvalArguments& arguments);

}  // namespace loopbench::harness
