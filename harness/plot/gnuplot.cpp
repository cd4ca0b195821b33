#include "harness/plot/gnuplot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "harness/plot/run_gnuplot.hpp"
#include "harness/text/printable.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {
namespace {

/// Single-quoted gnuplot string: quotes are doubled; line breaks are not possible in it. gnuplot
/// rejects a string that begins with a quote, so a space precedes it.
std::string gnuplot_quoted(const std::string& text) {
  std::string out = text.starts_with('\'') ? "' " : "'";
  for (const char c : printable(text))
    out += c == '\'' ? "''" : std::string(1, c == '\n' ? ' ' : c);
  return out + "'";
}

std::string data_block(const std::string& name, const PlotSeries& series) {
  std::string out = fmt::format("${} << EOD\n", name);
  for (const Vector3& p : series.points) {
    out += p.allFinite() ? fmt::format("{:.6g} {:.6g} {:.6g}\n", p.x(), p.y(), p.z()) : "\n";
  }
  return out + "EOD\n";
}

/// Range of an axis. gnuplot warns about empty ranges (planar paths, errors across the plane), so
/// these are widened to `least` or a tenth of the number.
std::string axis_range(const char* axis,
                       const std::vector<PlotSeries>& series,
                       Eigen::Index coordinate,
                       double least) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const PlotSeries& each : series) {
    for (const Vector3& p : each.points) {
      if (!p.allFinite()) continue;
      low = std::min(low, p(coordinate));
      high = std::max(high, p(coordinate));
    }
  }
  const double pad = std::max(least, 0.1 * std::abs(low));
  if (low > high || high - low > 1e-9 * pad) return fmt::format("set {}range [*:*]\n", axis);
  return fmt::format("set {}range [{:.6g}:{:.6g}]\n", axis, low - pad, high + pad);
}

std::string ranges(const PlotPanel& panel) {
  constexpr double kLeastHeight = 1.0;   // [m]
  constexpr double kLeastError = 0.001;  // [m] or [deg]
  const bool is_map = panel.spatial || panel.same_scale;
  return axis_range("y", panel.series, 1, is_map ? kLeastHeight : kLeastError) +
         axis_range("z", panel.series, 2, kLeastHeight);
}

std::string panel_script(const PlotPanel& panel, std::size_t index) {
  std::string blocks;
  std::string plots;
  for (std::size_t s = 0; s < panel.series.size(); ++s) {
    const PlotSeries& series = panel.series[s];
    const std::string name = fmt::format("d{}_{}", index, s);
    blocks += data_block(name, series);
    plots += fmt::format(
        "{}${} using {} with {} lc rgb {} title {}",
        s == 0 ? "" : ", ",
        name,
        panel.spatial ? "1:2:3" : "1:2",
        series.as_points ? "points pt 7 ps 0.5" : fmt::format("lines lw {:g}", series.width),
        gnuplot_quoted(series.color),
        gnuplot_quoted(series.name));
  }
  return blocks + ranges(panel) +
         fmt::format("set title {}\nset xlabel {}\nset ylabel {}\nset zlabel {}\n{}\n{} {}\n",
                     gnuplot_quoted(panel.title),
                     gnuplot_quoted(panel.x_label),
                     gnuplot_quoted(panel.y_label),
                     gnuplot_quoted(panel.spatial ? panel.z_label : ""),
                     panel.spatial || !panel.same_scale ? "set size noratio" : "set size ratio -1",
                     panel.spatial ? "splot" : "plot",
                     plots);
}

/// Width and height in points.
std::string terminal(const std::filesystem::path& file, std::size_t width, std::size_t height) {
  if (file.extension() == ".pdf") {
    return fmt::format("pdfcairo size {:.3f}in,{:.3f}in noenhanced font 'sans,9'",
                       static_cast<double>(width) / 72.0,
                       static_cast<double>(height) / 72.0);
  }
  return fmt::format(
      "svg size {},{} dynamic noenhanced background '#ffffff' font 'sans,12'", width, height);
}

}  // namespace

void write_figure(const std::filesystem::path& file,
                  const std::vector<PlotPanel>& panels,
                  std::size_t columns) {
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  std::string script = fmt::format(
      "set terminal {}\n"
      "set grid lc rgb '#dddddd'\nset key outside below\nset border lc rgb "
      "'#666666'\n"
      "set multiplot layout {},{}\n",
      terminal(file, 640 * columns, 480 * rows),
      rows,
      columns);
  for (std::size_t i = 0; i < panels.size(); ++i) script += panel_script(panels[i], i);
  script += "unset multiplot\n";

  write_result(file, drawn_by_gnuplot(script));
}

std::vector<Vector3> thinned(const std::vector<Vector3>& points, std::size_t most) {
  if (points.size() <= most) return points;
  const std::size_t step = (points.size() + most - 2) / (most - 1);
  std::vector<Vector3> out;
  for (std::size_t i = 0; i + 1 < points.size(); i += step) out.push_back(points[i]);
  out.push_back(points.back());
  return out;
}

}  // namespace loopbench::harness
