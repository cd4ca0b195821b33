/// Evaluation of every estimate under every protocol, of trajectories in files or in memory.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/error.hpp"
#include "harness/eval/arguments.hpp"
#include "harness/eval/evaluation_result.hpp"
#include "harness/execution/run/doctor_notes.hpp"

namespace loopbench::harness {

/// Two trajectories in memory, and what is known of their files.
struct EvaluationInput {
  ReadPair read;  ///< the reference in the body of the estimate
  ReadFindings findings = {};
  const metrics::PrintedPoses* printed = nullptr;
  std::string reference_unstamped = {};  ///< file and format if stamps were generated, or empty
  std::string estimate_unstamped = {};
  std::string reference_content = {};  ///< see EvaluationResult, as is
  std::string content = {};            ///< this
};

/// Returns an error if only one file has stamps, since numbers and stamps would be paired by
/// chance; otherwise an empty text. `one`, `other`: file and format if the stamps were generated,
/// or empty.
std::string why_two_clocks(const EvalArguments& arguments,
                           const metrics::Protocol& protocol,
                           const std::string& one,
                           const std::string& other);

/// Returns one result for each protocol. Throws InputError if the evaluation fails and
/// `throws_failures` is set; otherwise its result has a `why_failed`.
std::vector<EvaluationResult> evaluate_read(const EvalArguments& arguments,
                                            const std::vector<metrics::NamedProtocol>& protocols,
                                            const EvaluationInput& input,
                                            bool throws_failures);

/// Error for a times file without KITTI poses.
InputError unused_times(const EvalArguments& arguments);

/// Error for a period without files that lack stamps.
InputError unused_period(const EvalArguments& arguments);

/// Returns one result for each estimate and protocol, in that order. If there are several, an
/// estimate that cannot be read or evaluated has a result with `why_failed`. Throws InputError,
/// OptionError.
std::vector<EvaluationResult> evaluate_files(const EvalArguments& arguments);

}  // namespace loopbench::harness
