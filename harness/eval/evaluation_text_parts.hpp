/// Parts that the text formats of `eval` have in common.
#pragma once

#include <string>
#include <vector>

#include "harness/eval/evaluation_result.hpp"
#include "harness/tables/notes.hpp"

namespace loopbench::harness {

/// "evo (align=se3) [26d0953]": label and version.
std::string protocol_text(const metrics::NamedProtocol& protocol);

/// Undefined scores and failed metrics, as notes of `row`.
std::vector<Missing> missing_scores(const EvaluationResult& result, const std::string& row);

}  // namespace loopbench::harness
