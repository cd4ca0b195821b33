#include "harness/eval/trajectory_figures.hpp"

#include <algorithm>

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostRowsOfTrajectories = 2000;  // of a curve; more are not visible

DrawnCurve curve_of(const std::string& name,
                    const CurveStyle& style,
                    const Trajectory& poses,
                    double origin) {
  DrawnCurve out{name, style, {}};
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

}  // namespace

FigureData trajectory_figure(const std::vector<NamedTrajectory>& all,
                             const std::optional<NamedTrajectory>& reference) {
  double origin =
      reference ? reference->file.poses.front().stamp : all.front().file.poses.front().stamp;
  for (const NamedTrajectory& each : all) {
    if (!reference) origin = std::min(origin, each.file.poses.front().stamp);
  }
  FigureData out;
  if (reference) {
    out.curves.push_back(curve_of("reference", kReferenceStyle, reference->file.poses, origin));
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    out.curves.push_back(curve_of(all[i].name, curve_style(i), all[i].file.poses, origin));
  }
  DrawnFigure& figure = out.figures.emplace_back(DrawnFigure{{}, {}, 4, 4.5, 3.6, 9.0});
  figure.panels = {"xy", "xz", "yz", "xyz", "x by time", "y by time", "z by time"};
  for (const char* const panel : {"roll by time", "pitch by time", "yaw by time"}) {
    figure.panels.emplace_back(panel);
  }
  const auto has_speed = [](const DrawnCurve& curve) { return curve.columns.contains("speed"); };
  if (std::ranges::any_of(out.curves, has_speed)) figure.panels.emplace_back("speed by time");
  return out;
}

}  // namespace loopbench::harness
