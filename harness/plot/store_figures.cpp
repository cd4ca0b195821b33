#include "harness/plot/store_figures.hpp"

#include <algorithm>
#include <array>

#include "harness/plot/style.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostPlotted = 800;  // points per curve; more are not visible in print

/// Of a trace, in the reference's world frame.
Vector3 origin_of(const std::optional<SequenceTrace>& trace) {
  if (!trace) return Vector3::Zero();
  return {trace->origin.x, trace->origin.y, trace->origin.z};
}

std::vector<Vector3> positions(const std::vector<TracePose>& poses, const Vector3& origin) {
  std::vector<Vector3> out;
  for (const TracePose& p : poses) out.push_back(origin + Vector3(p.x, p.y, p.z));
  return out;
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

/// A panel of trajectories and its coordinates; in space all three.
struct MapPanel {
  PlotPanel panel;
  std::vector<Eigen::Index> axes;

  Vector3 seen(const Vector3& p) const {
    return panel.spatial ? p : Vector3(p[axes[0]], p[axes[1]], 0.0);
  }
  void add(PlotSeries style, const std::vector<Vector3>& points) {
    for (const Vector3& p : points) style.points.push_back(seen(p));
    style.points = thinned(style.points, kMostPlotted);
    panel.series.push_back(std::move(style));
  }
};

std::vector<MapPanel> map_panels(const std::string& sequence,
                                 const std::vector<std::string>& names) {
  std::vector<MapPanel> out;
  for (const std::string& name : names) {
    if (!name.starts_with("x") && !name.starts_with("y")) continue;
    if (name.size() < 2) continue;
    MapPanel& map = out.emplace_back();
    for (const char axis : name) map.axes.push_back(axis - 'x');
    map.panel.spatial = name.size() == 3;
    map.panel.title = sequence + (map.panel.spatial ? " in space" : "");
    if (map.panel.spatial) continue;
    map.panel.x_label = std::string(1, name[0]) + " [m]";
    map.panel.y_label = std::string(1, name[1]) + " [m]";
  }
  return out;
}

/// A panel of errors and its axis; 3: angle.
struct ErrorPanel {
  PlotPanel panel;
  Eigen::Index axis = 0;
};

std::vector<ErrorPanel> error_panels(const std::string& sequence,
                                     const std::vector<std::string>& names) {
  std::vector<ErrorPanel> out;
  for (const std::string& name : names) {
    const bool is_angle = name == "angle";
    if (!is_angle && name.size() > 1) continue;
    ErrorPanel& error = out.emplace_back();
    error.axis = is_angle ? 3 : name[0] - 'x';
    error.panel.title = sequence;
    error.panel.x_label = "path of the reference [m]";
    error.panel.y_label = "error " + name + (is_angle ? " [deg]" : " [m]");
    error.panel.same_scale = false;
  }
  return out;
}

void add_errors(std::vector<ErrorPanel>& panels,
                const CellTrace& trace,
                const std::string& method,
                const CurveStyle& style) {
  const std::vector<double> length = lengths(trace.samples);
  for (auto& [panel, axis] : panels) {
    PlotSeries series{method, style.color, false, {}, kLineWidth, style.dash};
    for (std::size_t i = 0; i < trace.samples.size(); ++i) {
      const TraceSample& s = trace.samples[i];
      const double value = axis < 3 ? error(s)(axis) : s.error_angle;
      series.points.emplace_back(length[i], value, 0.0);
    }
    series.points = thinned(series.points, kMostPlotted);
    panel.series.push_back(std::move(series));
  }
}

}  // namespace

const std::vector<std::string>& panel_names() {
  static const std::vector<std::string> names{"xy", "xz", "yz", "xyz", "x", "y", "z", "angle"};
  return names;
}

SequenceFigures sequence_figures(const std::vector<CellRecord>& cells,
                                 Traces& traces,
                                 const std::string& sequence,
                                 const std::vector<std::string>& methods,
                                 const std::vector<std::string>& all_methods,
                                 const std::vector<std::string>& panels) {
  std::optional<std::int64_t> first;
  for (const CellRecord& cell : cells) {
    if (cell.sequence == sequence) first = std::min(first.value_or(cell.repeat), cell.repeat);
  }
  std::vector<MapPanel> maps = map_panels(sequence, panels);
  std::vector<ErrorPanel> errors = error_panels(sequence, panels);
  std::optional<SequenceTrace> sequence_trace;
  bool is_first = true;
  for (const std::string& method : methods) {
    const auto cell = std::ranges::find_if(cells, [&](const CellRecord& c) {
      return c.sequence == sequence && c.repeat == first && c.method == method;
    });
    if (cell == cells.end()) continue;
    const std::optional<CellTrace> trace = traces.cell(cell->position);
    if (!trace || trace->samples.empty()) continue;
    if (is_first) sequence_trace = traces.sequence(cell->position);
    const Vector3 origin = origin_of(sequence_trace);
    for (MapPanel& map : maps) {
      if (!is_first || !sequence_trace) break;
      map.add({"reference", kReferenceColor, false, {}},
              positions(sequence_trace->reference, origin));
    }
    is_first = false;
    std::vector<Vector3> estimate;
    for (const TraceSample& sample : trace->samples) estimate.push_back(origin + position(sample));
    const auto index = std::ranges::find(all_methods, method) - all_methods.begin();
    const CurveStyle style = curve_style(static_cast<std::size_t>(index));
    for (MapPanel& map : maps) {
      map.add({method, style.color, false, {}, kLineWidth, style.dash}, estimate);
    }
    add_errors(errors, *trace, method, style);
  }
  SequenceFigures out;
  if (is_first) return out;
  for (MapPanel& map : maps) out.trajectories.push_back(std::move(map.panel));
  for (ErrorPanel& error : errors) out.errors.push_back(std::move(error.panel));
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
