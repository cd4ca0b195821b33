/// Pages of results/paper for configs that are not tables 1 to 4: readings, argument, spacing.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/article/paper_run.hpp"

namespace loopbench::harness {

/// One table per dataset, methods as rows: ATE per axis at keyframes and densely, change of the
/// dense 3-D ATE against `baseline`, and rotation error, RPE and closure residual if measured.
/// Methods that use the reference are marked, with what they use below the table. O(cells).
std::string method_tables(const std::vector<PaperCell>& cells, const std::string& baseline);

/// If keyframe intervals are swept, a table of the median gain over all runs for each interval.
/// Then one table, datasets as rows: median keyframe interval, median angle between consecutive
/// steps, error of the baseline, what is left with exact keyframes, headroom, and the gain of each
/// method in dense 3-D ATE over `baseline` [%].
std::string gain_matrix(const std::vector<PaperCell>& cells, const std::string& baseline);

/// The gains over the median keyframe interval: one panel per sequence with several intervals.
void gain_figure(const std::vector<PaperCell>& cells,
                 const std::string& baseline,
                 const std::filesystem::path& file);

}  // namespace loopbench::harness
