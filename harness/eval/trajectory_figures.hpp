/// Figures of trajectory files.
#pragma once

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/eval/named_trajectory.hpp"
#include "harness/report/draw.hpp"

namespace loopbench::harness {

/// The plane of the largest extent and space; x, y, z, roll, pitch, yaw and speed over time. Any
/// panel can also be xy, xz or yz.
inline std::vector<std::string> default_trajectory_panels() {
  return {"plane", "xyz", "x", "y", "z", "roll", "pitch", "yaw", "speed"};
}

inline constexpr std::size_t kMostRowsOfTrajectories = 2000;  // of a curve; more are not visible

/// Adds the columns of a trajectory.
inline DrawnCurve with_columns(DrawnCurve out, const Trajectory& poses, double origin) {
  add_poses(out, poses, origin);
  std::vector<std::string> peaks;
  if (poses.size() > 1) {
    peaks = {"speed"};
    std::vector<double>& speed = out.columns["speed"];
    for (std::size_t i = 1; i < poses.size(); ++i) {
      const Vector3 step =
          poses[i].world_from_body.translation - poses[i - 1].world_from_body.translation;
      speed.push_back(step.norm() / (poses[i].stamp - poses[i - 1].stamp));
    }
    speed.insert(speed.begin(), speed.front());
  }
  thin(out, kMostRowsOfTrajectories, peaks);
  return out;
}

inline std::vector<std::string> short_names(const std::vector<NamedTrajectory>& all) {
  std::vector<std::string> stems, names;
  for (const NamedTrajectory& each : all) {
    names.push_back(each.name);
    stems.push_back(output_stem(each.name));
  }
  return std::set(stems.begin(), stems.end()).size() == all.size() ? stems : names;
}

/// One figure without files. Names without a label are file names without folder and extension, if
/// these differ. Times count from the first stamp of the reference, or of all
/// trajectories.
inline FigureData trajectory_figure(const std::vector<NamedTrajectory>& all,
                                    const std::optional<NamedTrajectory>& reference,
                                    const std::vector<std::string>& panels,
                                    const FigureOptions& options) {
  double origin =
      reference ? reference->file.poses.front().stamp : all.front().file.poses.front().stamp;
  for (const NamedTrajectory& each : all) {
    if (!reference) origin = std::min(origin, each.file.poses.front().stamp);
  }
  FigureData out;
  if (reference) {
    out.curves.push_back(with_columns(reference_curve(), reference->file.poses, origin));
    out.title = "no alignment";
  }
  const std::vector<std::string> names = labels_of(options, short_names(all));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const DrawnCurve curve{.name = names[i], .style = i};
    out.curves.push_back(with_columns(curve, all[i].file.poses, origin));
  }
  DrawnFigure& figure = out.figures.emplace_back(DrawnFigure{{}, {}, options});
  if (!options.columns) figure.options.columns = 3;
  for (const std::string& panel : panels) {
    const bool is_map = panel == "plane" || panel.find_first_not_of("xyz") == std::string::npos;
    figure.panels.push_back(is_map && panel.size() > 1 ? panel : panel + " by time");
  }
  return out;
}

}  // namespace loopbench::harness
