/// The page of `eval --report`: that of `report` for evaluations in memory.
#pragma once

#include <vector>

#include "harness/eval/recorded_evaluation.hpp"
#include "harness/run/collect_provenance.hpp"

namespace loopbench::harness {

/// Writes the page to the file of --report, by way of a store in a temporary folder. Names of
/// --labels replace those of the systems if there are as many. Throws InputError.
void write_evaluation_page(RecordedSweep files,
                           const std::vector<EvaluatedFile>& evaluations,
                           const Source& source);

}  // namespace loopbench::harness
