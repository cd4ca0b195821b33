#include "harness/plot/store_figures.hpp"

#include <algorithm>
#include <array>

#include "harness/plot/style.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostPlotted = 800;  // points per curve; more are not visible in print
std::vector<Vector3> positions(const std::vector<TracePose>& poses) {
  std::vector<Vector3> out;
  for (const TracePose& p : poses) out.emplace_back(p.x, p.y, p.z);
  return thinned(out, kMostPlotted);
}

Vector3 position(const TraceSample& s) { return {s.estimate.x, s.estimate.y, s.estimate.z}; }
Vector3 error(const TraceSample& s) { return {s.error_x, s.error_y, s.error_z}; }

/// Length of the reference's path up to each sample [m].
std::vector<double> lengths(const std::vector<TraceSample>& samples) {
  std::vector<double> out(samples.size(), 0.0);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const Vector3 before = position(samples[i - 1]) - error(samples[i - 1]);
    out[i] = out[i - 1] + (position(samples[i]) - error(samples[i]) - before).norm();
  }
  return out;
}

void add_errors(std::vector<PlotPanel>& panels,
                const CellTrace& trace,
                const std::string& method,
                const CurveStyle& style) {
  const std::vector<double> length = lengths(trace.samples);
  for (std::size_t axis = 0; axis < panels.size(); ++axis) {
    PlotSeries series{method, style.color, false, {}, kLineWidth, style.dash};
    for (std::size_t i = 0; i < trace.samples.size(); ++i) {
      const TraceSample& s = trace.samples[i];
      const double value = axis < 3 ? error(s)(static_cast<Eigen::Index>(axis)) : s.error_angle;
      series.points.emplace_back(length[i], value, 0.0);
    }
    series.points = thinned(series.points, kMostPlotted);
    panels[axis].series.push_back(std::move(series));
  }
}

}  // namespace

SequenceFigures sequence_figures(const std::vector<CellRecord>& cells,
                                 Traces& traces,
                                 const std::string& sequence,
                                 const std::vector<std::string>& methods,
                                 const std::vector<std::string>& all_methods) {
  std::optional<std::int64_t> first;
  for (const CellRecord& cell : cells) {
    if (cell.sequence == sequence) first = std::min(first.value_or(cell.repeat), cell.repeat);
  }
  SequenceFigures out;
  std::vector<PlotPanel> maps(2);
  maps[0].title = sequence;
  maps[1].title = sequence + " in space";
  maps[1].spatial = true;
  std::vector<PlotPanel> errors(4);
  constexpr std::array kNames{"x [m]", "y [m]", "z [m]", "angle [deg]"};
  for (std::size_t axis = 0; axis < errors.size(); ++axis) {
    errors[axis].title = sequence;
    errors[axis].x_label = "path of the reference [m]";
    errors[axis].y_label = std::string("error ") + kNames[axis];
    errors[axis].same_scale = false;
  }
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const auto cell = std::ranges::find_if(cells, [&](const CellRecord& c) {
      return c.sequence == sequence && c.repeat == first && c.method == methods[m];
    });
    if (cell == cells.end()) continue;
    const std::optional<CellTrace> trace = traces.cell(cell->position);
    if (!trace || trace->samples.empty()) continue;
    if (maps[0].series.empty()) {
      if (const auto whole = traces.sequence(cell->position)) {
        for (PlotPanel& map : maps) {
          map.series.push_back({"reference", kReferenceColor, false, positions(whole->reference)});
        }
      }
    }
    std::vector<Vector3> estimate;
    for (const TraceSample& sample : trace->samples) estimate.push_back(position(sample));
    const auto index = std::ranges::find(all_methods, methods[m]) - all_methods.begin();
    const CurveStyle style = curve_style(static_cast<std::size_t>(index));
    for (PlotPanel& map : maps) {
      map.series.push_back({methods[m],
                            style.color,
                            false,
                            thinned(estimate, kMostPlotted),
                            kLineWidth,
                            style.dash});
    }
    add_errors(errors, *trace, methods[m], style);
  }
  if (errors[0].series.empty()) return out;
  out.trajectories = std::move(maps);
  out.errors = std::move(errors);
  return out;
}

std::string file_stem(const std::string& label) {
  std::string out;
  for (const char c : label) {
    const bool is_plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    if (is_plain) {
      out += c;
    } else if (!out.empty() && out.back() != '_') {
      out += '_';
    }
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  return out.substr(0, 80);
}

}  // namespace loopbench::harness
