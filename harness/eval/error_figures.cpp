#include "harness/eval/error_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "harness/plot/map_panel.hpp"
#include "harness/plot/style.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/numerics/euler.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostErrorPoints = 1500;

double position_error(const DrawnEvaluation& e, std::size_t i) {
  return (e.estimate[i].world_from_body.translation - e.reference[i].world_from_body.translation)
      .norm();
}

double rotation_error(const DrawnEvaluation& e, std::size_t i) {
  return metrics::kDegrees * angle_between(e.estimate[i].world_from_body.rotation,
                                           e.reference[i].world_from_body.rotation);
}

/// Evenly chosen indices, with the last one.
std::vector<std::size_t> drawn_indices(std::size_t size) {
  const std::size_t step = size / kMostErrorPoints + 1;
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i + 1 < size; i += step) out.push_back(i);
  if (size > 0) out.push_back(size - 1);
  return out;
}

PlotPanel map_of(const std::vector<DrawnEvaluation>& all, int a, int b) {
  PlotPanel out = empty_map(a, b);
  const bool is_colored = all.size() == 1;
  if (is_colored) out.value_label = "position error [m]";
  for (std::size_t k = 0; k < all.size(); ++k) {
    const DrawnEvaluation& e = all[k];
    const CurveStyle style = curve_style(k);
    PlotSeries reference{k == 0 ? "reference" : "", kReferenceColor, false, {}};
    PlotSeries estimate{e.name, style.color, false, {}, kLineWidth, style.dash};
    for (const std::size_t i : drawn_indices(e.estimate.size())) {
      reference.points.push_back(on_map(e.reference[i].world_from_body.translation, a, b));
      estimate.points.push_back(on_map(e.estimate[i].world_from_body.translation, a, b));
      if (is_colored) estimate.values.push_back(position_error(e, i));
    }
    if (k == 0) out.series.push_back(reference);
    out.series.push_back(estimate);
    for (const PlotMark mark : {PlotMark::start, PlotMark::end}) {
      PlotSeries marked = estimate;
      marked.mark = mark;
      marked.values.clear();
      marked.name.clear();
      if (is_colored) marked.name = mark == PlotMark::start ? "start" : "end";
      out.series.push_back(std::move(marked));
    }
  }
  return out;
}

template <class Along, class Value>
PlotPanel curves_of(const std::vector<DrawnEvaluation>& all,
                    const std::string& x_label,
                    const std::string& y_label,
                    Along along,
                    Value value) {
  PlotPanel out;
  out.same_scale = false;
  out.x_label = x_label;
  out.y_label = y_label;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const CurveStyle style = curve_style(k);
    PlotSeries series{all[k].name, style.color, false, {}, kLineWidth, style.dash};
    const std::vector<double> x = along(all[k]);
    for (const std::size_t i : drawn_indices(all[k].estimate.size())) {
      series.points.emplace_back(x[i], value(all[k], i), 0.0);
    }
    out.series.push_back(std::move(series));
  }
  return out;
}

std::vector<double> times_of(const DrawnEvaluation& e) {
  std::vector<double> out;
  for (const StampedPose& pose : e.reference) {
    out.push_back(pose.stamp - e.reference.front().stamp);
  }
  return out;
}

std::vector<double> distances_of(const DrawnEvaluation& e) {
  std::vector<double> out(e.reference.size(), 0.0);
  for (std::size_t i = 1; i < out.size(); ++i) {
    out[i] = out[i - 1] + (e.reference[i].world_from_body.translation -
                           e.reference[i - 1].world_from_body.translation)
                              .norm();
  }
  return out;
}

PlotPanel histogram_of(const std::vector<DrawnEvaluation>& all) {
  constexpr std::size_t kBins = 40;
  PlotPanel out;
  out.same_scale = false;
  out.x_label = "position error [m]";
  out.y_label = "share of poses [%]";
  double largest = 0.0;
  for (const DrawnEvaluation& e : all) {
    for (std::size_t i = 0; i < e.estimate.size(); ++i) {
      largest = std::max(largest, position_error(e, i));
    }
  }
  if (!(largest > 0.0)) largest = 1.0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const DrawnEvaluation& e = all[k];
    std::array<std::size_t, kBins> counts{};
    for (std::size_t i = 0; i < e.estimate.size(); ++i) {
      const double bin = position_error(e, i) / largest * static_cast<double>(kBins);
      ++counts[std::min(kBins - 1, static_cast<std::size_t>(bin))];
    }
    const CurveStyle style = curve_style(k);
    PlotSeries series{e.name, style.color, false, {}, kLineWidth, style.dash};
    if (all.size() == 1) series.mark = PlotMark::bars;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      series.points.emplace_back(
          largest * (static_cast<double>(bin) + 0.5) / static_cast<double>(kBins),
          100.0 * static_cast<double>(counts[bin]) / static_cast<double>(e.estimate.size()),
          0.0);
    }
    out.series.push_back(std::move(series));
  }
  return out;
}

/// Position or Euler angle of a pose.
double component(const Pose& pose, std::size_t axis) {
  if (axis < 3) return pose.translation[static_cast<Eigen::Index>(axis)];
  const metrics::Euler angles = metrics::euler(pose.rotation);
  return metrics::kDegrees * std::array{angles.roll, angles.pitch, angles.yaw}[axis - 3];
}

PlotPanel axis_of(const std::vector<DrawnEvaluation>& all, std::size_t axis) {
  constexpr std::array kNames{"x [m]", "y [m]", "z [m]", "roll [deg]", "pitch [deg]", "yaw [deg]"};
  PlotPanel out =
      curves_of(all, "time [s]", kNames[axis], times_of, [&](const DrawnEvaluation& e, auto i) {
        return component(e.estimate[i].world_from_body, axis);
      });
  PlotSeries reference{"reference", kReferenceColor, false, {}};
  const std::vector<double> times = times_of(all.front());
  for (const std::size_t i : drawn_indices(times.size())) {
    reference.points.emplace_back(
        times[i], component(all.front().reference[i].world_from_body, axis), 0.0);
  }
  out.series.insert(out.series.begin(), std::move(reference));
  return out;
}

}  // namespace

std::vector<NamedFigure> error_figures(const std::vector<DrawnEvaluation>& all) {
  NamedFigure maps{"trajectories",
                   {map_of(all, 0, 1), map_of(all, 0, 2), map_of(all, 1, 2), map_of(all, 0, 0)},
                   2};
  NamedFigure errors{"errors", {}, 2};
  errors.panels = {
      curves_of(all, "time [s]", "position error [m]", times_of, position_error),
      curves_of(all, "distance [m]", "position error [m]", distances_of, position_error),
      curves_of(all, "time [s]", "rotation error [deg]", times_of, rotation_error),
      curves_of(all, "distance [m]", "rotation error [deg]", distances_of, rotation_error),
      histogram_of(all)};
  NamedFigure axes{"axes", {}, 3};
  for (std::size_t axis = 0; axis < 6; ++axis) axes.panels.push_back(axis_of(all, axis));
  return {maps, errors, axes};
}

std::vector<std::string> write_error_figures(const std::string& prefix,
                                             const std::vector<DrawnEvaluation>& all) {
  const FigureSize kColumn{3.5, 2.8, 8.0, true};  // one column of a paper
  std::vector<std::string> out;
  for (const NamedFigure& figure : error_figures(all)) {
    for (const char* const extension : {".svg", ".pdf", ".png"}) {
      out.push_back(prefix + "_" + figure.name + extension);
      write_figure(out.back(), figure.panels, figure.columns, kColumn);
    }
  }
  return out;
}

}  // namespace loopbench::harness
