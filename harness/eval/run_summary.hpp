/// Statistics over the runs of each system, and the verdict.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/compare/compare.hpp"
#include "harness/tables/table.hpp"

namespace loopbench::harness {

/// Runs of one method on one sequence.
struct RunSummary {
  std::string sequence;
  std::string method;
  std::size_t runs = 0;              ///< with different data
  std::size_t copies = 0;            ///< further runs, whose data are those of another; not counted
  metrics::Statistics values;        ///< of the runs with sufficient coverage and without failure
  std::optional<Interval> interval;  ///< 95 % of the pseudo-median; none below six values
};

/// Summaries of the score with the protocol, label, relation, axis and unit of `score`, by sequence
/// and method in the order of the records.
std::vector<RunSummary> summarise_runs(const std::vector<Record>& records, const Record& score);

/// For each protocol the table of the summaries and the verdict over all runs: which method is
/// better, and whether that is proven. The score is the translational ATE or, if it was not
/// requested, the first one with a direction, or an axis of it if there is no total. Empty below
/// two methods and two runs. Equal runs count once, as in compare(). Markdown without a style.
std::string run_report(const std::vector<Record>& records,
                       const std::optional<TerminalStyle>& style = std::nullopt,
                       bool paired = false);

}  // namespace loopbench::harness
