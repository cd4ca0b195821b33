#include "harness/eval/error_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "harness/plot/map_panel.hpp"
#include "harness/plot/style.hpp"
#include "harness/plot/wraps.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/numerics/euler.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostPoints = 1000;  // of a curve

double position_error(const DrawnEvaluation& e, std::size_t i) {
  return (e.estimate[i].world_from_body.translation - e.reference[i].world_from_body.translation)
      .norm();
}

double rotation_error(const DrawnEvaluation& e, std::size_t i) {
  return metrics::kDegrees * angle_between(e.estimate[i].world_from_body.rotation,
                                           e.reference[i].world_from_body.rotation);
}

/// Evenly chosen indices, at most about kMostPoints, with the last one.
std::vector<std::size_t> even_indices(std::size_t size) {
  const std::size_t step = size / (kMostPoints + 1) + 1;
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i + 1 < size; i += step) out.push_back(i);
  if (size > 0) out.push_back(size - 1);
  return out;
}

/// The least and the greatest value of equal parts, so that no peak is lost, at most about
/// kMostPoints; with the first and the last value.
std::vector<std::size_t> extreme_indices(const std::vector<double>& values) {
  if (values.size() <= kMostPoints) return even_indices(values.size());
  const std::size_t step = 2 * values.size() / kMostPoints + 1;
  const auto at = [&](std::size_t i) { return values.begin() + static_cast<std::ptrdiff_t>(i); };
  std::vector<std::size_t> out{0};
  for (std::size_t first = 1; first + 1 < values.size(); first += step) {
    const std::size_t end = std::min(first + step, values.size() - 1);
    const auto [low, high] = std::minmax_element(at(first), at(end));
    const auto [one, other] = std::minmax({low - values.begin(), high - values.begin()});
    out.push_back(static_cast<std::size_t>(one));
    if (other != one) out.push_back(static_cast<std::size_t>(other));
  }
  out.push_back(values.size() - 1);
  return out;
}

PlotPanel map_of(const std::vector<DrawnEvaluation>& all, int a, int b) {
  PlotPanel out = empty_map(a, b);
  const bool is_colored = all.size() == 1;
  if (is_colored) out.value_label = "position error [m]";
  PlotSeries reference{"reference", kReferenceColor, false, {}};
  for (const StampedPose& pose : all.front().complete) {
    reference.points.push_back(on_map(pose.world_from_body.translation, a, b));
  }
  out.series.push_back(std::move(reference));
  for (const DrawnEvaluation& e : all) {
    const CurveStyle& style = e.style;
    PlotSeries estimate{e.name, style.color, false, {}, kLineWidth, style.dash};
    for (const std::size_t i : even_indices(e.estimate.size())) {
      estimate.points.push_back(on_map(e.estimate[i].world_from_body.translation, a, b));
      if (is_colored) estimate.values.push_back(position_error(e, i));
    }
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

using Abscissa = std::vector<double> DrawnEvaluation::*;

template <class Value>
PlotPanel curves_of(const std::vector<DrawnEvaluation>& all,
                    const std::string& x_label,
                    const std::string& y_label,
                    Abscissa along,
                    Value value) {
  PlotPanel out;
  out.same_scale = false;
  out.x_label = x_label;
  out.y_label = y_label;
  for (const DrawnEvaluation& e : all) {
    PlotSeries series{e.name, e.style.color, false, {}, kLineWidth, e.style.dash};
    std::vector<double> values;
    for (std::size_t i = 0; i < e.estimate.size(); ++i) values.push_back(value(e, i));
    for (const std::size_t i : extreme_indices(values)) {
      series.points.emplace_back((e.*along)[i], values[i], 0.0);
    }
    out.series.push_back(std::move(series));
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
  for (const DrawnEvaluation& e : all) {
    std::array<std::size_t, kBins> counts{};
    for (std::size_t i = 0; i < e.estimate.size(); ++i) {
      const double bin = position_error(e, i) / largest * static_cast<double>(kBins);
      ++counts[std::min(kBins - 1, static_cast<std::size_t>(bin))];
    }
    PlotSeries series{e.name, e.style.color, false, {}, kLineWidth, e.style.dash};
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
  PlotPanel out = curves_of(all,
                            "time [s]",
                            kNames[axis],
                            &DrawnEvaluation::times,
                            [&](const DrawnEvaluation& e, auto i) {
                              return component(e.estimate[i].world_from_body, axis);
                            });
  PlotSeries reference{"reference", kReferenceColor, false, {}};
  for (const StampedPose& pose : all.front().complete) {
    reference.points.emplace_back(pose.stamp, component(pose.world_from_body, axis), 0.0);
  }
  out.series.insert(out.series.begin(), std::move(reference));
  if (axis >= 3) break_at_wraps(out);
  return out;
}

}  // namespace

std::vector<NamedFigure> error_figures(const std::vector<DrawnEvaluation>& all) {
  NamedFigure maps{"trajectories",
                   {map_of(all, 0, 1), map_of(all, 0, 2), map_of(all, 1, 2), map_of(all, 0, 0)},
                   2};
  NamedFigure errors{"errors", {}, 2};
  errors.panels = {
      curves_of(all, "time [s]", "position error [m]", &DrawnEvaluation::times, position_error),
      curves_of(
          all, "distance [m]", "position error [m]", &DrawnEvaluation::distances, position_error),
      curves_of(all, "time [s]", "rotation error [deg]", &DrawnEvaluation::times, rotation_error),
      curves_of(
          all, "distance [m]", "rotation error [deg]", &DrawnEvaluation::distances, rotation_error),
      histogram_of(all)};
  NamedFigure axes{"axes", {}, 3};
  for (std::size_t axis = 0; axis < 6; ++axis) axes.panels.push_back(axis_of(all, axis));
  return {maps, errors, axes};
}

std::vector<FigureFile> error_figure_files(const std::string& prefix,
                                           const std::vector<DrawnEvaluation>& all,
                                           const std::string& note,
                                           const ErrorFigureSize& size) {
  constexpr double kColumnWidth = 3.5;                  // of a paper [in]
  constexpr double kMapShape = 0.9, kCurveShape = 0.4;  // height over width
  std::vector<FigureFile> out;
  for (const NamedFigure& figure : error_figures(all)) {
    const bool is_map = figure.panels.front().same_scale;
    const std::size_t columns = size.columns > 0 ? size.columns : (is_map ? 2 : 1);
    FigureSize panel;
    panel.width = kColumnWidth / static_cast<double>(columns);
    panel.height = panel.width * (is_map || columns > 1 ? kMapShape : kCurveShape);
    if (size.panel.size() == 2) {
      panel.width = size.panel[0];
      panel.height = size.panel[1];
    }
    panel.font = size.font;
    panel.common_legend = true;
    panel.note = note;
    const auto panels = std::make_shared<const std::vector<PlotPanel>>(figure.panels);
    for (const char* const extension : {".svg", ".pdf", ".png"}) {
      out.push_back({prefix + "_" + figure.name + extension, panels, columns, panel});
    }
  }
  return out;
}

}  // namespace loopbench::harness
