/// Estimates that are drawn together.
#pragma once

#include <string>
#include <vector>

#include "harness/eval/evaluation_result.hpp"
#include "harness/eval/recorded_runs.hpp"

namespace loopbench::harness {

/// Evaluations with the same reference, which share figures.
struct DrawnRuns {
  std::string sequence;  ///< label; empty if there is only one
  std::vector<DrawnEvaluation> drawn;
  std::string note;  ///< how many estimates are not drawn; empty: all are
};

inline constexpr std::size_t kMostDrawnEstimates = 6;  ///< in a figure; more hide each other

/// The estimates evaluated under the first protocol, by reference. `runs[i / protocols]` belongs to
/// `all[i]`. The name of an estimate is its method, or method and run if a method has several. A
/// method has the same colour in all figures; its further runs are dashed, or have colours of their
/// own if there is only one method. Of more than kMostDrawnEstimates, the run of median ATE of each
/// method is drawn, for the first methods, or the best, median and worst of a single method;
/// incomplete ones only if there are no others.
std::vector<DrawnRuns> drawn_sequences(const std::vector<EvaluationResult>& all,
                                       const std::vector<RecordedRun>& runs);

}  // namespace loopbench::harness
