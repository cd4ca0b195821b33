#include "harness/article/run_pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "harness/article/cell_labels.hpp"
#include "harness/article/verdict.hpp"
#include "harness/plot/gnuplot.hpp"
#include "methods/smoothers/manifold/nodes.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

using metrics::Times;

/// A column of numbers, hidden if no cell has them.
struct ScoreColumn {
  const char* title;
  const char* label;
  const char* axis;
  Times times;
  const char* relation;
  double factor;
  int digits;
};
constexpr ScoreColumn kScoreColumns[] = {
    {"x, keyframes [mm]", "axis_error", "x", Times::keyframes, "translation", 1e3, 1},
    {"y", "axis_error", "y", Times::keyframes, "translation", 1e3, 1},
    {"z", "axis_error", "z", Times::keyframes, "translation", 1e3, 1},
    {"3-D", "ate", "3d", Times::keyframes, "translation", 1e3, 1},
    {"x, densely [mm]", "axis_error", "x", Times::dense, "translation", 1e3, 1},
    {"y", "axis_error", "y", Times::dense, "translation", 1e3, 1},
    {"z", "axis_error", "z", Times::dense, "translation", 1e3, 1},
    {"3-D", "ate", "3d", Times::dense, "translation", 1e3, 1},
    {"rotation [deg]", "ate", "3d", Times::dense, "rotation", 1.0, 2},
    {"RPE 1 s [mm]", "rpe 1 s", "3d", Times::dense, "translation", 1e3, 1},
    {"closure residual [mm]", "closure_residual", "3d", Times::keyframes, "translation", 1e3, 1},
    {"[deg]", "closure_residual", "3d", Times::keyframes, "rotation", 1.0, 2},
};

/// Whether the processor time is below the recording's: only this is reproducible.
std::string is_real_time(const PaperCell& cell) {
  const std::vector<double>& seconds =
      cell.result.cpu_seconds.empty() ? cell.result.seconds : cell.result.cpu_seconds;
  if (seconds.empty() || cell.keyframes.size() < 2) return "";
  const double duration = cell.keyframes.back().stamp - cell.keyframes.front().stamp;
  return seconds.front() < duration ? "yes" : "no";
}

std::string method_table(const std::vector<PaperCell>& cells,
                         const std::string& dataset,
                         const std::string& baseline) {
  std::vector<const ScoreColumn*> shown;
  for (const ScoreColumn& column : kScoreColumns) {
    if (std::ranges::any_of(cells, [&](const PaperCell& cell) {
          return dataset_of(cell) == dataset &&
                 find_score(cell, column.label, column.axis, column.times, column.relation) !=
                     nullptr;
        })) {
      shown.push_back(&column);
    }
  }
  std::string out = fmt::format("\n## {}\n\n| method |", dataset);
  std::string rule = "| --- |";
  for (const ScoreColumn* column : shown) {
    out += fmt::format(" {} |", column->title);
    rule += " ---: |";
  }
  out += " change of dense 3-D | faster than recorded |\n" + rule + " ---: | ---: |\n";
  std::vector<std::string> notes;
  const double reference = dense_ate(cell_of(cells, dataset, baseline));
  for (const PaperCell& cell : cells) {
    if (dataset_of(cell) != dataset) continue;
    out += fmt::format("| {}{} |", method_of(cell), cell.result.oracle_method ? " (oracle)" : "");
    if (cell.result.status != Status::ok) {
      for (std::size_t k = 0; k < shown.size(); ++k) out += " |";
      out += fmt::format(" {} | |\n", cell.result.why);
      continue;
    }
    for (const ScoreColumn* column : shown) {
      const metrics::Statistics* found =
          find_score(cell, column->label, column->axis, column->times, column->relation);
      out += found ? fmt::format(" {:.{}f} |", column->factor * found->rmse, column->digits) : " |";
    }
    out += fmt::format(
        " {} | {} |\n", percent_change(dense_ate(&cell) / reference - 1.0), is_real_time(cell));
    for (const std::string& note : cell.result.report.notes) {
      if (note.starts_with("oracle") && std::ranges::count(notes, note) == 0) notes.push_back(note);
    }
  }
  for (const std::string& note : notes) out += "\n" + note + ".\n";
  return out;
}

/// Properties of a run's keyframes.
struct Spacing {
  double interval = 0.0;  ///< median [s]
  double angle = 0.0;     ///< median angle between consecutive steps [deg]
};

Spacing spacing(const Trajectory& keyframes) {
  const methods::manifold::Nodes nodes(keyframes);
  std::vector<double> intervals, angles;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) intervals.push_back(nodes.duration(i));
  for (std::size_t i = 0; i + 2 < nodes.size(); ++i) {
    angles.push_back(methods::manifold::angle_between_directions(nodes.step(i), nodes.step(i + 1)));
  }
  if (angles.empty()) return {};
  return {metrics::median(intervals), 180.0 / std::numbers::pi * metrics::median(angles)};
}

double score_or_nan(const PaperCell& cell, const char* label, const char* relation) {
  for (const ScoreResult& s : cell.result.scores) {
    if (s.status == Status::ok && s.label == label && s.score.relation == relation &&
        s.times == metrics::Times::dense) {
      return s.score.statistics.rmse;
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::string fixed_or_blank(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "";
}

const std::string kInterval = " (keyframes.value=";

/// Value of the swept keyframe interval in a dataset's label; empty without one.
std::string interval_of(const std::string& dataset) {
  const std::size_t at = dataset.find(kInterval);
  if (at == std::string::npos) return "";
  return dataset.substr(at + kInterval.size(), dataset.size() - at - kInterval.size() - 1);
}

/// Per keyframe interval: median gain of each method, and in how many runs it gains.
std::string gain_summary(const std::vector<PaperCell>& cells,
                         const std::string& baseline,
                         const std::vector<std::string>& methods) {
  std::vector<std::string> intervals;
  for (const std::string& dataset : distinct(cells, dataset_of)) {
    const std::string interval = interval_of(dataset);
    if (!interval.empty() && std::ranges::count(intervals, interval) == 0)
      intervals.push_back(interval);
  }
  if (intervals.empty()) return "";
  std::string out = "\n## Median gain [%] over all runs, and the number of runs with a gain\n\n";
  std::string head = "| interval at least [s] |", rule = "| ---: |";
  for (const std::string& method : methods) {
    if (method == baseline) continue;
    head += fmt::format(" {} |", method);
    rule += " ---: |";
  }
  out += head + "\n" + rule + "\n";
  for (const std::string& interval : intervals) {
    out += fmt::format("| {} |", interval);
    for (const std::string& method : methods) {
      if (method == baseline) continue;
      std::vector<double> gains;
      for (const PaperCell& cell : cells) {
        if (method_of(cell) != method || interval_of(dataset_of(cell)) != interval) continue;
        const double gain =
            100.0 *
            (1.0 - dense_ate(&cell) / dense_ate(cell_of(cells, dataset_of(cell), baseline)));
        if (std::isfinite(gain)) gains.push_back(gain);
      }
      if (gains.empty()) {
        out += " |";
        continue;
      }
      out += fmt::format(" {} ({} of {}) |",
                         signed_tenths(metrics::median(gains)),
                         std::ranges::count_if(gains, [](double g) { return g > 0.0; }),
                         gains.size());
    }
    out += "\n";
  }
  return out + "\n## Runs\n";
}

}  // namespace

std::string method_tables(const std::vector<PaperCell>& cells, const std::string& baseline) {
  std::string out;
  for (const std::string& dataset : distinct(cells, dataset_of)) {
    out += method_table(cells, dataset, baseline);
  }
  return out;
}

std::string gain_matrix(const std::vector<PaperCell>& cells, const std::string& baseline) {
  const std::vector<std::string> methods = distinct(cells, method_of);
  std::string out = gain_summary(cells, baseline, methods);
  out += "\n| run | interval [s] | angle [deg] | ATE [mm] | exact keyframes [mm] | headroom [%] |";
  std::string rule = "| --- | ---: | ---: | ---: | ---: | ---: |";
  for (const std::string& method : methods) {
    if (method == baseline) continue;
    out += fmt::format(" {} |", method);
    rule += " ---: |";
  }
  out += "\n" + rule + "\n";
  for (const std::string& dataset : distinct(cells, dataset_of)) {
    const PaperCell* raw = cell_of(cells, dataset, baseline);
    if (raw == nullptr || raw->keyframes.empty()) continue;
    const Spacing at = spacing(raw->keyframes);
    out +=
        fmt::format("| {} | {:.2f} | {:.1f} | {:.1f} | {} | {} |",
                    dataset,
                    at.interval,
                    at.angle,
                    1e3 * dense_ate(raw),
                    fixed_or_blank(1e3 * score_or_nan(*raw, "interpolation_floor", "polyline"), 1),
                    fixed_or_blank(score_or_nan(*raw, "smoothing_headroom", "gain"), 1));
    for (const std::string& method : methods) {
      if (method == baseline) continue;
      const PaperCell* cell = cell_of(cells, dataset, method);
      const double gain = 100.0 * (1.0 - dense_ate(cell) / dense_ate(raw));
      out += std::isfinite(gain) ? " " + signed_tenths(gain) + " |" : " |";
    }
    out += "\n";
  }
  return out;
}

void gain_figure(const std::vector<PaperCell>& cells,
                 const std::string& baseline,
                 const std::filesystem::path& file) {
  constexpr const char* kCurveColors[] = {"#2ca02c",
                                          "#9467bd",
                                          "#8c564b",
                                          "#1f4fd6",
                                          "#17a2b8",
                                          "#d62728",
                                          "#ff7f0e",
                                          "#7f7f7f",
                                          "#000000",
                                          "#bcbd22"};
  const std::vector<std::string> methods = distinct(cells, method_of);
  const auto stem = [](const PaperCell& cell) {
    return dataset_of(cell).substr(0, dataset_of(cell).find(kInterval));
  };
  std::vector<PlotPanel> panels;
  for (const PaperCell& first : cells) {
    if (std::ranges::any_of(panels, [&](const PlotPanel& p) { return p.title == stem(first); }))
      continue;
    PlotPanel panel;
    panel.title = stem(first);
    panel.x_label = "median keyframe interval [s]";
    panel.y_label = "gain in dense 3-D ATE [%]";
    panel.same_scale = false;
    std::size_t color = 0;
    for (const std::string& method : methods) {
      if (method == baseline) continue;
      PlotSeries series{method, kCurveColors[color++ % std::size(kCurveColors)], false, {}};
      for (const PaperCell& cell : cells) {
        if (stem(cell) != panel.title || method_of(cell) != method || cell.keyframes.empty())
          continue;
        const double raw = dense_ate(cell_of(cells, dataset_of(cell), baseline));
        const double gain = 100.0 * (1.0 - dense_ate(&cell) / raw);
        if (std::isfinite(gain))
          series.points.push_back({spacing(cell.keyframes).interval, std::max(gain, -30.0), 0.0});
      }
      panel.series.push_back(std::move(series));
    }
    const bool is_curve =
        std::ranges::all_of(panel.series, [](const PlotSeries& s) { return s.points.size() >= 2; });
    if (is_curve) panels.push_back(std::move(panel));
  }
  if (!panels.empty()) write_figure(file, panels, 3);
}

}  // namespace loopbench::harness
