#include "harness/plot/gnuplot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "datasets/core/error.hpp"

namespace loopbench {
namespace {

/// Single-gnuplot_quoted gnuplot text: a quote is doubled, a line break cannot stand in it.
std::string gnuplot_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "''" : std::string(1, c == '\n' ? ' ' : c);
  return out + "'";
}

std::string data_block(const std::string& name, const PlotSeries& series) {
  std::string out = fmt::format("${} << EOD\n", name);
  for (const Vector3& p : series.points) {
    out += p.allFinite() ? fmt::format("{:.6g} {:.6g} {:.6g}\n", p.x(), p.y(), p.z()) : "\n";
  }
  return out + "EOD\n";
}

/// Heights of a path in the plane are one number, a range that gnuplot warns about and widens.
std::string height_range(const PlotPanel& panel) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  double across = 0.0;
  for (const PlotSeries& series : panel.series) {
    for (const Vector3& p : series.points) {
      if (!p.allFinite()) continue;
      low = std::min(low, p.z());
      high = std::max(high, p.z());
      across = std::max({across, std::abs(p.x()), std::abs(p.y())});
    }
  }
  if (!panel.spatial || low > high || high - low > 1e-6 * across) return "set zrange [*:*]\n";
  const double pad = across > 0.0 ? 0.1 * across : 1.0;
  return fmt::format("set zrange [{:.6g}:{:.6g}]\n", low - pad, high + pad);
}

std::string panel_script(const PlotPanel& panel, std::size_t index) {
  std::string blocks;
  std::string plots;
  for (std::size_t s = 0; s < panel.series.size(); ++s) {
    const PlotSeries& series = panel.series[s];
    const std::string name = fmt::format("d{}_{}", index, s);
    blocks += data_block(name, series);
    plots += fmt::format("{}${} using {} with {} lc rgb {} title {}",
                         s == 0 ? "" : ", ",
                         name,
                         panel.spatial ? "1:2:3" : "1:2",
                         series.as_points ? "points pt 7 ps 0.5" : "lines lw 1.4",
                         gnuplot_quoted(series.color),
                         gnuplot_quoted(series.name));
  }
  return blocks + height_range(panel) +
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
      "set output {}\nset grid lc rgb '#dddddd'\nset key outside below\nset border lc rgb "
      "'#666666'\n"
      "set multiplot layout {},{}\n",
      terminal(file, 640 * columns, 480 * rows),
      gnuplot_quoted(file.string()),
      rows,
      columns);
  for (std::size_t i = 0; i < panels.size(); ++i) script += panel_script(panels[i], i);
  script += "unset multiplot\n";

  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  std::FILE* pipe = popen("gnuplot 2>&1 >/dev/null", "w");
  if (pipe == nullptr) throw InputError(file.string() + ": cannot start gnuplot");
  const bool sent = std::fwrite(script.data(), 1, script.size(), pipe) == script.size();
  if (pclose(pipe) != 0 || !sent || !std::filesystem::exists(file)) {
    throw InputError(file.string() + ": gnuplot could not draw it (package gnuplot-nox)");
  }
}

std::vector<Vector3> thinned(const std::vector<Vector3>& points, std::size_t most) {
  if (points.size() <= most) return points;
  const std::size_t step = (points.size() + most - 2) / (most - 1);
  std::vector<Vector3> out;
  for (std::size_t i = 0; i + 1 < points.size(); i += step) out.push_back(points[i]);
  out.push_back(points.back());
  return out;
}

}  // namespace loopbench
