#include "harness/trajectory/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "harness/plot/map_panel.hpp"
#include "harness/plot/style.hpp"
#include "harness/plot/wraps.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/numerics/euler.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostDrawn = 2000;  // points per curve; more are not visible

struct DrawnTrajectory {
  std::string name;
  const Trajectory& poses;
  CurveStyle style;
};

PlotSeries series_of(const DrawnTrajectory& drawn,
                     const std::vector<Vector3>& points,
                     bool is_named) {
  return {is_named ? drawn.name : "",
          drawn.style.color,
          false,
          thinned(points, kMostDrawn),
          kLineWidth,
          drawn.style.dash};
}

/// Plane with axes a and b; a == b: space.
PlotPanel map_panel(const std::vector<DrawnTrajectory>& all, int a, int b) {
  PlotPanel out = empty_map(a, b);
  for (const DrawnTrajectory& drawn : all) {
    std::vector<Vector3> points;
    for (const StampedPose& pose : drawn.poses) {
      points.push_back(on_map(pose.world_from_body.translation, a, b));
    }
    out.series.push_back(series_of(drawn, points, true));
    for (const PlotMark mark : {PlotMark::start, PlotMark::end}) {
      PlotSeries ends = series_of(drawn, points, false);
      ends.mark = mark;
      out.series.push_back(std::move(ends));
    }
  }
  return out;
}

template <class Value>
PlotPanel time_panel(const std::vector<DrawnTrajectory>& all,
                     double origin,
                     const std::string& label,
                     Value value) {
  PlotPanel out;
  out.same_scale = false;
  out.x_label = "time [s]";
  out.y_label = label;
  for (const DrawnTrajectory& drawn : all) {
    std::vector<Vector3> points;
    for (std::size_t i = 0; i < drawn.poses.size(); ++i) {
      points.emplace_back(drawn.poses[i].stamp - origin, value(drawn.poses, i), 0.0);
    }
    out.series.push_back(series_of(drawn, points, true));
  }
  return out;
}

double speed_at(const Trajectory& poses, std::size_t i) {
  if (i == 0) return std::numeric_limits<double>::quiet_NaN();
  const Vector3 step =
      poses[i].world_from_body.translation - poses[i - 1].world_from_body.translation;
  return step.norm() / (poses[i].stamp - poses[i - 1].stamp);
}

}  // namespace

std::vector<PlotPanel> trajectory_panels(const std::vector<NamedTrajectory>& all,
                                         const std::optional<NamedTrajectory>& reference) {
  std::vector<DrawnTrajectory> drawn;
  if (reference) drawn.push_back({"reference", reference->file.poses, {kReferenceColor, 1}});
  for (std::size_t i = 0; i < all.size(); ++i) {
    drawn.push_back({all[i].name, all[i].file.poses, curve_style(i)});
  }
  double origin = std::numeric_limits<double>::infinity();
  for (const DrawnTrajectory& each : drawn) {
    origin = std::min(origin, each.poses.front().stamp);
    if (reference) break;
  }
  std::vector<PlotPanel> out{map_panel(drawn, 0, 1),
                             map_panel(drawn, 0, 2),
                             map_panel(drawn, 1, 2),
                             map_panel(drawn, 0, 0)};
  constexpr std::array kAngles{"roll [deg]", "pitch [deg]", "yaw [deg]"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.push_back(
        time_panel(drawn, origin, kAxisLabels[axis], [&](const Trajectory& poses, auto i) {
          return poses[i].world_from_body.translation[static_cast<Eigen::Index>(axis)];
        }));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.push_back(time_panel(drawn, origin, kAngles[axis], [&](const Trajectory& poses, auto i) {
      const auto angles = metrics::euler(poses[i].world_from_body.rotation);
      return metrics::kDegrees * std::array{angles.roll, angles.pitch, angles.yaw}[axis];
    }));
    break_at_wraps(out.back());
  }
  const auto has_speed = [](const DrawnTrajectory& each) { return each.poses.size() > 1; };
  if (std::ranges::any_of(drawn, has_speed)) {
    out.push_back(time_panel(drawn, origin, "speed [m/s]", speed_at));
  }
  return out;
}

void check_figure_name(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".svg" || extension == ".pdf" || extension == ".png") return;
  throw InputError(file.string() + ": expected a file name that ends in .svg, .pdf or .png");
}

void write_trajectory_figure(const std::filesystem::path& file,
                             const std::vector<NamedTrajectory>& all,
                             const std::optional<NamedTrajectory>& reference) {
  check_figure_name(file);
  write_figure(file, trajectory_panels(all, reference), 4, {4.5, 3.6, 9.0, true});
}

}  // namespace loopbench::harness
