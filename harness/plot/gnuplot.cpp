#include "harness/plot/gnuplot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "datasets/core/parallel.hpp"
#include "harness/plot/axes.hpp"
#include "harness/plot/legend.hpp"
#include "harness/plot/quoted.hpp"
#include "harness/plot/run_gnuplot.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {
namespace {

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

/// The colour bar of a page: its range from 0 to the largest value, with four intervals.
struct ColorBar {
  std::string label;  ///< empty: no bar
  double largest = 0.0;
};

ColorBar color_bar(const std::vector<PlotPanel>& panels) {
  ColorBar out;
  for (const PlotPanel& panel : panels) {
    if (out.label.empty()) out.label = panel.value_label;
    for (const PlotSeries& series : panel.series) {
      for (const double value : series.values) out.largest = std::max(out.largest, value);
    }
  }
  if (!(out.largest > 0.0)) out.largest = 1.0;
  return out;
}

/// In a row at the bottom of the page; its height [in].
double height_of(const ColorBar& bar, double font) {
  return bar.label.empty() ? 0.0 : 4.2 * font / 72.0;
}

std::string script_of(const ColorBar& bar, double font, double page_height) {
  if (bar.label.empty()) return "unset colorbox\n";
  const double em = font / 72.0 / page_height;
  return fmt::format(
      "set colorbox horizontal user origin screen 0.2,{:.5f} size screen 0.6,{:.5f}\n"
      "set cblabel {} offset 0,0.6\nset cbrange [0:{:.6g}]\nset cbtics {:.1g} offset 0,0.5\n",
      3.2 * em,
      0.7 * em,
      gnuplot_quoted(bar.label),
      bar.largest,
      0.25 * bar.largest);
}

/// `setup`: commands for the ranges. The legend has the names if there is one for all panels.
std::string panel_script(const PlotPanel& panel,
                         std::size_t index,
                         const std::string& setup,
                         bool is_named) {
  std::string blocks;
  std::string plots;
  for (std::size_t s = 0; s < panel.series.size(); ++s) {
    const PlotSeries& series = panel.series[s];
    const std::string name = fmt::format("d{}_{}", index, s);
    blocks += data_block(name, series);
    plots += fmt::format(
        "{}${} using {}{} with {} {}",
        s == 0 ? "" : ", ",
        name,
        panel.spatial ? "1:2:3" : "1:2",
        series.values.empty() ? "" : ":4",
        with_style(series),
        is_named && !series.name.empty() ? "title " + gnuplot_quoted(series.name) : "notitle");
  }
  const bool has_equal_axes = is_named && !panel.spatial && panel.same_scale;
  return blocks + setup +
         fmt::format("set title {}\nset xlabel {}\nset ylabel {}\nset zlabel {}\n{}\n{} {}\n",
                     gnuplot_quoted(panel.title),
                     gnuplot_quoted(panel.x_label),
                     gnuplot_quoted(panel.y_label),
                     gnuplot_quoted(panel.spatial ? panel.z_label : ""),
                     has_equal_axes ? "set size ratio -1" : "set size noratio",
                     panel.spatial ? "splot" : "plot",
                     plots);
}

/// [pt]
double font_size(const std::filesystem::path& file, const FigureSize& size) {
  if (size.font > 0.0) return size.font;
  return file.extension() == ".svg" ? 12.0 : 9.0;
}

std::string terminal(
    const std::filesystem::path& file, double width, double height, double font, double pixels) {
  constexpr double kPoints = 72.0;  // per inch
  // Font size, line width and marks of PNG are for 96 and 72 pixels per inch.
  constexpr double kFontPixels = 96.0, kLinePixels = 110.0;
  if (file.extension() == ".pdf") {
    return fmt::format(
        "pdfcairo size {:.3f}in,{:.3f}in noenhanced font 'sans,{:g}'", width, height, font);
  }
  if (file.extension() == ".png") {
    return fmt::format(
        "pngcairo size {:.0f},{:.0f} noenhanced font 'sans,{:g}' linewidth {:g} pointscale {:g}",
        width * pixels,
        height * pixels,
        font * pixels / kFontPixels,
        std::max(1.0, pixels / kLinePixels),
        std::max(1.0, pixels / kLinePixels));
  }
  return fmt::format(
      "svg size {:.0f},{:.0f} dynamic noenhanced background '#ffffff' font 'sans,{:g}'",
      width * kPoints,
      height * kPoints,
      font);
}

constexpr const char* kCommon =
    "set grid lc rgb '#dddddd'\nset key outside below horizontal samplen 2\nset border lc rgb "
    "'#666666'\nset palette defined (0 '#2c7bb6', 0.5 '#ffd24d', 1 '#d7191c')\n";

/// Panels in boxes of the same size, the legend above and the colour bar below them.
std::string page_with_legend(const std::filesystem::path& file,
                             const std::vector<PlotPanel>& panels,
                             std::size_t columns,
                             const FigureSize& size) {
  const double width = size.width * static_cast<double>(columns);
  // Per inch of a PNG: 300, as journals require, unless the page is wider than one of a journal.
  const double pixels = std::clamp(3000.0 / width, 150.0, 300.0);
  const double font = font_size(file, size);
  const Legend legend(panels, size.note, width, font);
  const ColorBar bar = color_bar(panels);
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  const double top = height_of(bar, font) + size.height * static_cast<double>(rows);
  const double height = top + legend.height();
  std::string out = fmt::format("set terminal {}\n{}set tics scale 0.6\nset multiplot\nunset key\n",
                                terminal(file, width, height, font, pixels),
                                kCommon);
  out += legend.script(height) + script_of(bar, font, height);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const PanelBox box{static_cast<double>(i % columns) * size.width,
                       top - size.height * (1.0 + static_cast<double>(i / columns)),
                       size.width,
                       size.height,
                       width,
                       height};
    out += panel_script(panels[i], i, framed(panels[i], box, font), false);
    if (i == 0) out += "unset label\nunset colorbox\n";
  }
  return out;
}

std::string page_of_panels(const std::filesystem::path& file,
                           const std::vector<PlotPanel>& panels,
                           std::size_t columns,
                           const FigureSize& size) {
  constexpr double kPixels = 150.0;  // per inch of a PNG
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  std::string out = fmt::format("set terminal {}\n{}set multiplot layout {},{}\nunset colorbox\n",
                                terminal(file,
                                         size.width * static_cast<double>(columns),
                                         size.height * static_cast<double>(rows),
                                         font_size(file, size),
                                         kPixels),
                                kCommon,
                                rows,
                                columns);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    out += panel_script(panels[i], i, ranges(panels[i]), true);
  }
  return out;
}

}  // namespace

void write_figure(const std::filesystem::path& file,
                  const std::vector<PlotPanel>& panels,
                  std::size_t columns,
                  const FigureSize& size) {
  const auto draw = size.common_legend ? page_with_legend : page_of_panels;
  write_result(file, drawn_by_gnuplot(draw(file, panels, columns, size) + "unset multiplot\n"));
}

void write_figures(const std::vector<FigureFile>& files) {
  parallel_for_tasks(files.size(), [&](std::size_t i) {
    write_figure(files[i].file, *files[i].panels, files[i].columns, files[i].size);
  });
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
