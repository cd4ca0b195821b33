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
  const bool is_end = series.mark == PlotMark::end && !series.points.empty();
  const std::size_t first = is_end ? series.points.size() - 1 : 0;
  const std::size_t end = series.mark == PlotMark::start
                              ? std::min<std::size_t>(1, series.points.size())
                              : series.points.size();
  for (std::size_t i = first; i < end; ++i) {
    const Vector3& p = series.points[i];
    const double value = series.values.empty() ? 0.0 : series.values[i];
    out += p.allFinite() ? fmt::format("{:.7g} {:.7g} {:.7g} {:.6g}\n", p.x(), p.y(), p.z(), value)
                         : "\n";
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

/// The plotting style of a series.
std::string with_style(const PlotSeries& series) {
  const std::string color = gnuplot_quoted(series.color);
  if (series.mark == PlotMark::start) return "points pt 6 ps 1.2 lw 2 lc rgb " + color;
  if (series.mark == PlotMark::end) return "points pt 5 ps 1 lc rgb " + color;
  if (series.mark == PlotMark::bars) return "boxes fill solid 0.6 lc rgb " + color;
  if (!series.values.empty()) return "lines lw 2 lc palette";
  if (series.as_points || series.mark == PlotMark::points) {
    return "points pt 7 ps 0.5 lc rgb " + color;
  }
  return fmt::format("lines lw {:g} dt {} lc rgb {}", series.width, series.dash, color);
}

/// The colour bar: from 0 to the largest value, with four intervals.
std::string value_axis(const PlotPanel& panel) {
  if (panel.value_label.empty()) return "unset colorbox\n";
  double largest = 0.0;
  for (const PlotSeries& series : panel.series) {
    for (const double value : series.values) largest = std::max(largest, value);
  }
  if (!(largest > 0.0)) largest = 1.0;
  return fmt::format("set colorbox\nset cblabel {}\nset cbrange [0:{:.6g}]\nset cbtics {:.1g}\n",
                     gnuplot_quoted(panel.value_label),
                     largest,
                     0.25 * largest);
}

std::string panel_script(const PlotPanel& panel, std::size_t index) {
  std::string blocks;
  std::string plots;
  for (std::size_t s = 0; s < panel.series.size(); ++s) {
    const PlotSeries& series = panel.series[s];
    const std::string name = fmt::format("d{}_{}", index, s);
    blocks += data_block(name, series);
    plots += fmt::format("{}${} using {}{} with {} {}",
                         s == 0 ? "" : ", ",
                         name,
                         panel.spatial ? "1:2:3" : "1:2",
                         series.values.empty() ? "" : ":4",
                         with_style(series),
                         series.name.empty() ? "notitle" : "title " + gnuplot_quoted(series.name));
  }
  blocks += value_axis(panel);
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

std::string terminal(const std::filesystem::path& file, double width, double height, double font) {
  constexpr double kPoints = 72.0, kPixels = 150.0;  // per inch
  constexpr double kFontPixels = 96.0;               // per inch, of a font size in PNG
  if (file.extension() == ".pdf") {
    return fmt::format("pdfcairo size {:.3f}in,{:.3f}in noenhanced font 'sans,{:g}'",
                       width,
                       height,
                       font > 0.0 ? font : 9.0);
  }
  if (file.extension() == ".png") {
    return fmt::format("pngcairo size {:.0f},{:.0f} noenhanced font 'sans,{:g}'",
                       width * kPixels,
                       height * kPixels,
                       (font > 0.0 ? font : 9.0) * kPixels / kFontPixels);
  }
  return fmt::format(
      "svg size {:.0f},{:.0f} dynamic noenhanced background '#ffffff' font 'sans,{:g}'",
      width * kPoints,
      height * kPoints,
      font > 0.0 ? font : 12.0);
}

}  // namespace

void write_figure(const std::filesystem::path& file,
                  const std::vector<PlotPanel>& panels,
                  std::size_t columns,
                  const FigureSize& size) {
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  std::string script = fmt::format(
      "set terminal {}\n"
      "set grid lc rgb '#dddddd'\nset key outside below horizontal samplen 2\nset border lc rgb "
      "'#666666'\nset palette defined (0 '#2c7bb6', 0.5 '#ffd24d', 1 '#d7191c')\n"
      "set multiplot layout {},{}\n",
      terminal(file,
               size.width * static_cast<double>(columns),
               size.height * static_cast<double>(rows),
               size.font),
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
