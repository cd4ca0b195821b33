/// Check for evaluations with too little coverage.
#pragma once

#include <string>

#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::harness {

/// Reason why the coverage (pairs or time) is below `min_coverage` (0..1); empty if it is not.
std::string incomplete_reason(const metrics::Coverage& coverage, double min_coverage);

}  // namespace loopbench::harness
