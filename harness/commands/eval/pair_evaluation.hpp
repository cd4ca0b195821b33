/// Evaluation of two files under the protocols of a sweep.
#pragma once

#include <string>

#include "harness/commands/eval/file_evaluation.hpp"

namespace loopbench::harness {

struct EvaluatedPair {
  const EvaluatedSweep& files;
  const EvaluatedFile& reference;
  const EvaluatedFile& estimate;
  std::string common;  ///< times to evaluate; empty: all
};

/// Adds scores, coverage and notes under each protocol of `out`, one after the other; or why there
/// are none.
void evaluate_pair(const EvaluatedPair& pair, FileEvaluation& out);

}  // namespace loopbench::harness
