#include "harness/plot/gnuplot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

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

/// Lower and upper bound of the finite coordinates; empty without any.
std::optional<std::pair<double, double>> bounds(const PlotPanel& panel, Eigen::Index coordinate) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const PlotSeries& series : panel.series) {
    for (const Vector3& p : series.points) {
      if (!p.allFinite()) continue;
      low = std::min(low, p(coordinate));
      high = std::max(high, p(coordinate));
    }
  }
  if (low > high) return std::nullopt;
  return std::pair{low, high};
}

/// The largest of 1, 2 and 5 times a power of ten that is at most `step`.
double round_step(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= step) return factor * power;
  }
  return power;
}

/// Distances of the tics of maps: the same for axes of the same scale, so that the labels of a
/// short axis do not overlap; otherwise automatic.
std::string tics(const PlotPanel& panel) {
  std::string out = "set xtics autofreq\nset ytics autofreq\nset ztics autofreq\n";
  if (!panel.spatial && !panel.same_scale) return out;
  std::array<double, 3> lengths{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto range = bounds(panel, static_cast<Eigen::Index>(axis));
    if (range) lengths[axis] = range->second - range->first;
  }
  const double longest = std::max(lengths[0], lengths[1]);
  if (!(longest > 0.0)) return out;
  const double step = round_step(panel.spatial ? 0.5 * longest : 0.3 * longest);
  out = fmt::format("set xtics {0:g}\nset ytics {0:g}\n", step);
  if (panel.spatial && lengths[2] > 1e-9 * longest) {
    out += fmt::format("set ztics {:g}\n", round_step(0.6 * lengths[2]));
  }
  return out;
}

std::string panel_script(const PlotPanel& panel, std::size_t index, bool has_round_tics) {
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
  blocks += value_axis(panel) + (has_round_tics ? tics(panel) : "");
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

/// One legend for all panels, above them: their series have the same names.
struct Legend {
  std::string script;
  double height = 0.0;  ///< [in]
};

Legend legend_of(const std::vector<PlotPanel>& panels, double width, double font) {
  constexpr double kPoint = 1.0 / 72.0;  // [in]
  constexpr double kLetter = 0.6;        // width over height
  constexpr double kSample = 6.0;        // letters of the line beside a name
  std::size_t names = 0, longest = 0;
  for (const PlotSeries& series : panels.front().series) {
    if (series.name.empty()) continue;
    ++names;
    longest = std::max(longest, series.name.size());
  }
  if (names == 0) return {"unset key\n", 0.0};
  const double entry = (static_cast<double>(longest) + kSample) * kLetter * font * kPoint;
  const auto columns = std::clamp<std::size_t>(static_cast<std::size_t>(width / entry), 1, names);
  const std::size_t rows = (names + columns - 1) / columns;
  return {fmt::format("set key at screen 0.5, screen 1.0 center top horizontal maxcols {} "
                      "samplen 2 Left reverse\n",
                      columns),
          1.35 * font * kPoint * (static_cast<double>(rows) + 1.0)};
}

/// [pt]
double font_size(const std::filesystem::path& file, const FigureSize& size) {
  if (size.font > 0.0) return size.font;
  return file.extension() == ".svg" ? 12.0 : 9.0;
}

std::string terminal(const std::filesystem::path& file, double width, double height, double font) {
  constexpr double kPoints = 72.0, kPixels = 150.0;  // per inch
  constexpr double kFontPixels = 96.0;               // per inch, of a font size in PNG
  if (file.extension() == ".pdf") {
    return fmt::format(
        "pdfcairo size {:.3f}in,{:.3f}in noenhanced font 'sans,{:g}'", width, height, font);
  }
  if (file.extension() == ".png") {
    return fmt::format("pngcairo size {:.0f},{:.0f} noenhanced font 'sans,{:g}'",
                       width * kPixels,
                       height * kPixels,
                       font * kPixels / kFontPixels);
  }
  return fmt::format(
      "svg size {:.0f},{:.0f} dynamic noenhanced background '#ffffff' font 'sans,{:g}'",
      width * kPoints,
      height * kPoints,
      font);
}

}  // namespace

void write_figure(const std::filesystem::path& file,
                  const std::vector<PlotPanel>& panels,
                  std::size_t columns,
                  const FigureSize& size) {
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  const double width = size.width * static_cast<double>(columns);
  const double font = font_size(file, size);
  const Legend legend = size.common_legend ? legend_of(panels, width, font) : Legend{};
  const double height = size.height * static_cast<double>(rows) + legend.height;
  std::string script = fmt::format(
      "set terminal {}\n"
      "set grid lc rgb '#dddddd'\nset key outside below horizontal samplen 2\nset border lc rgb "
      "'#666666'\nset palette defined (0 '#2c7bb6', 0.5 '#ffd24d', 1 '#d7191c')\n",
      terminal(file, width, height, font));
  script += size.common_legend ? "set multiplot\n"
                               : fmt::format("set multiplot layout {},{}\n", rows, columns);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    if (size.common_legend) {
      const double left = static_cast<double>(i % columns) * size.width;
      const double bottom =
          height - legend.height - size.height * (1.0 + static_cast<double>(i / columns));
      script += fmt::format("set size {:.6f},{:.6f}\nset origin {:.6f},{:.6f}\n{}",
                            size.width / width,
                            size.height / height,
                            left / width,
                            bottom / height,
                            i == 0 ? legend.script : "unset key\n");
    }
    script += panel_script(panels[i], i, size.common_legend);
  }
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
