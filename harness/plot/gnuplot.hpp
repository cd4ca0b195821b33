/// Vector graphics with gnuplot, without a display.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/core/so3.hpp"

namespace loopbench::harness {

/// One curve of a panel. Points in metres; NaN breaks the line.
struct PlotSeries {
  std::string name;   ///< in the legend; escaped for gnuplot
  std::string color;  ///< "#rrggbb"
  bool as_points = false;
  std::vector<Vector3> points;
  double width = 1.4;  ///< of the line [points]
};

struct PlotPanel {
  std::string title;
  std::string x_label = "x [m]";
  std::string y_label = "y [m]";
  std::string z_label = "z [m]";
  bool spatial = false;    ///< x, y and z; otherwise x and y
  bool same_scale = true;  ///< equal scales of x and y (in the plane only)
  std::vector<PlotSeries> series;
};

/// Panels row by row on one page, 640 x 480 points per panel: SVG, or PDF by the file's extension.
/// Throws InputError if gnuplot is missing or the file cannot be written.
void write_figure(const std::filesystem::path& file,
                  const std::vector<PlotPanel>& panels,
                  std::size_t columns);

/// Every k-th point such that at most `most` remain, including the last one; for drawing only.
std::vector<Vector3> thinned(const std::vector<Vector3>& points, std::size_t most);

}  // namespace loopbench::harness
