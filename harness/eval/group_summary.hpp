/// Summary of several evaluations: runs against each other, or estimates that share an alignment.
#pragma once

#include <vector>

#include "harness/eval/evaluation_result.hpp"

namespace loopbench::harness {

/// One row for each score of `ate` and `rpe` over all axes and protocol (and method, if there are
/// several references): number of results, median, minimum, maximum and interquartile range of the
/// protocol's statistic over them, and the rmse of all their errors. Pairwise: each result is a
/// pair of runs, otherwise an estimate. O(results log results).
Table group_summary(const std::vector<EvaluationResult>& results, bool is_pairwise);

}  // namespace loopbench::harness
