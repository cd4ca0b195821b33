/// Numbers that rest on too little of a trajectory.
#pragma once

#include <string>

#include "metrics/evaluation/evaluation.hpp"

namespace loopbench {

/// Why so little was judged that the numbers do not stand beside others: pairs or time covered are
/// below `min_coverage` (0..1). Empty when enough was.
std::string why_incomplete(const Coverage& coverage, double min_coverage);

}  // namespace loopbench
