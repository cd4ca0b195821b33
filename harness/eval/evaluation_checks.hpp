/// What `eval` remarks about an evaluation: the diagnosis, the frame and accuracy of the reference.
#pragma once

#include "harness/eval/recorded_evaluation.hpp"

namespace loopbench::harness {

/// Sets diagnosis, notes and other_body. O(n log n).
void add_checks(EvaluationResult& out,
                const metrics::Evaluation& evaluation,
                const RecordedFile& reference,
                const RecordedFile& estimate,
                const RecordedSweep& files);

}  // namespace loopbench::harness
