/// Vector graphics with gnuplot, without a display.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "datasets/core/so3.hpp"

namespace loopbench::harness {

inline constexpr double kLineWidth = 1.4;  // [points]

enum class PlotMark { line, points, bars, start, end };

/// One curve of a panel. Points in metres; NaN breaks the line.
struct PlotSeries {
  std::string name;   ///< in the legend, unless empty; escaped for gnuplot
  std::string color;  ///< "#rrggbb"
  bool as_points = false;
  std::vector<Vector3> points;
  double width = kLineWidth;        ///< of the line [points]
  int dash = 1;                     ///< dash type of gnuplot, 1 is solid
  PlotMark mark = PlotMark::line;   ///< start: circle, end: square at the last point
  std::vector<double> values = {};  ///< one per point: colours the line by value
};

struct PlotPanel {
  std::string title;
  std::string x_label = "x [m]";
  std::string y_label = "y [m]";
  std::string z_label = "z [m]";
  bool spatial = false;    ///< x, y and z; otherwise x and y
  bool same_scale = true;  ///< equal scales of x and y (in the plane only)
  std::vector<PlotSeries> series;
  std::string value_label = {};  ///< of the colour bar, if a series has values
};

/// Size of one panel and of its text, and the kind of legend.
struct FigureSize {
  double width = 640.0 / 72.0;   ///< [in]
  double height = 480.0 / 72.0;  ///< [in]
  double font = 0.0;             ///< [pt]; 0: 12 in SVG, 9 in PDF and PNG
  /// One legend above all panels, with the names of all of them, and one colour bar below them;
  /// otherwise each panel has its legend, and no values are drawn.
  bool common_legend = false;
  std::string note = {};  ///< line below the common legend
};

/// Panels row by row on one page: SVG, or PDF or PNG by the file's extension. Throws InputError if
/// gnuplot is missing or the file cannot be written.
void write_figure(const std::filesystem::path& file,
                  const std::vector<PlotPanel>& panels,
                  std::size_t columns,
                  const FigureSize& size = {});

/// A figure that is not written yet, see write_figure().
struct FigureFile {
  std::filesystem::path file;
  std::shared_ptr<const std::vector<PlotPanel>> panels;
  std::size_t columns = 1;
  FigureSize size = {};
};

/// Calls write_figure() for all of them, on all cores.
void write_figures(const std::vector<FigureFile>& files);

/// Every k-th point such that at most `most` remain, including the last one; for drawing only.
std::vector<Vector3> thinned(const std::vector<Vector3>& points, std::size_t most);

}  // namespace loopbench::harness
