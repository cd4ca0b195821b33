/// `check --history`: what changed between the baselines of several commits.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace loopbench::harness {

struct HistoryOptions {
  std::vector<std::filesystem::path> files;  ///< baselines in the order of their commits
  std::filesystem::path chart;               ///< figure to draw, or empty
  std::vector<std::string> where;            ///< filters of the chart's scores
};

/// Prints, for every two consecutive files, other definitions and the findings of the gate with the
/// limits of the earlier file, and draws the chart. Baselines without common cells are stated and
/// not compared. Throws InputError for fewer than two files, for a file that is no baseline, and if
/// the chart has no score.
void check_history(const HistoryOptions& options);

}  // namespace loopbench::harness
