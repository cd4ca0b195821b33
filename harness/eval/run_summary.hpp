/// Statistics over runs: of each system with the verdict, against each other, or aligned together.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/eval/evaluation_result.hpp"
#include "harness/model/record.hpp"
#include "harness/tables/table.hpp"

namespace loopbench::harness {

/// For each protocol a table with mean, interval, median and range over the runs of each method on
/// each sequence (the interval is 95 % of the pseudo-median; none below six successful runs), and
/// the verdict over all runs: which method is better, and whether that is proven. The score is the
/// translational ATE or, if it was not requested, the first one with a direction, or an axis of it
/// if there is no total. Empty below two methods and two runs. Equal runs count once, as in
/// compare(). Markdown without a style.
std::string run_report(const std::vector<Record>& records,
                       const std::optional<TerminalStyle>& style = std::nullopt,
                       bool paired = false);

/// One row for each score of `ate` and `rpe` over all axes and protocol (and method, if there are
/// several references): number of results, median, minimum, maximum and interquartile range of the
/// protocol's statistic over them, and the rmse of all their errors. Pairwise: each result is a
/// pair of runs, otherwise an estimate. O(results log results).
Table group_summary(const std::vector<EvaluationResult>& results, bool is_pairwise);

}  // namespace loopbench::harness
