/// Figures of evaluations and of trajectory files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/answers/report/draw.hpp"
#include "harness/commands/eval/evaluated_runs.hpp"
#include "harness/commands/eval/evaluation_result.hpp"
#include "harness/commands/files/named_trajectory.hpp"

namespace loopbench::harness {

/// EvaluationResult::drawn. `reference`: the complete one, ascending stamps. O(n log n).
std::vector<DrawnCurve> drawn_evaluation(const Trajectory& reference,
                                         const metrics::Evaluation& evaluation);

inline constexpr std::size_t kMostEstimates = 96;  ///< of one page; figures have panels for twelve

/// The reference and the estimates evaluated under the first protocol, without figures; no curves
/// if all failed. The title has sequence, alignment and score. `runs[i / protocols]` belongs to
/// `all[i]`. The name of an estimate is its method, or method and run if a method has several. The
/// further runs of a method are dashed, or have colours of their own if there is only one method.
/// Of more than kMostEstimates, those with the smallest errors are drawn, as the note says.
FigureData drawn_runs(const std::vector<EvaluationResult>& all,
                      const std::vector<EvaluatedRun>& runs);

/// A page of all panels for drawn_runs(): the plane of the largest extent and space; position and
/// rotation error over time, histogram and box plot of the position error; x, y, z, roll, pitch and
/// yaw over time. `name`: a figure, or .pdf is added.
DrawnFigure evaluation_page(const std::filesystem::path& name);

/// The plane of the largest extent and space; x, y, z, roll, pitch, yaw and speed over time. Any
/// panel can also be xy, xz or yz.
inline std::vector<std::string> default_trajectory_panels() {
  return {"plane", "xyz", "x", "y", "z", "roll", "pitch", "yaw", "speed"};
}

/// One figure without files. Names without a label are file names without folder and extension, if
/// these differ. Times count from the first stamp of the reference, or of all
/// trajectories.
FigureData trajectory_figure(const std::vector<NamedTrajectory>& all,
                             const std::optional<NamedTrajectory>& reference,
                             const std::vector<std::string>& panels,
                             const FigureOptions& options);

}  // namespace loopbench::harness
