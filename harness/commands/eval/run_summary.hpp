/// Statistics over the runs of each system, with the verdict.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/answers/tables/table.hpp"
#include "harness/sweep/model/record.hpp"

namespace loopbench::harness {

/// For each protocol a table with mean and standard deviation over the runs of each method on each
/// sequence, as `table --plus-minus` prints it, and the verdict over all runs: which method is
/// better, and whether that is proven. The score is the translational ATE or, if it was not
/// requested, the first one with a direction, or an axis of it if there is no total. Empty below
/// two methods and two runs. Markdown without a style.
std::string run_report(const std::vector<Record>& records,
                       const std::optional<TerminalStyle>& style = std::nullopt);

}  // namespace loopbench::harness
