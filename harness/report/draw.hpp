/// Draws figures with the Python package (module loopbench.draw, matplotlib).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/report/curve.hpp"

namespace loopbench::harness {

/// Panels: "xy", "xz", "yz", "xyz" (space), "COLUMN by time", "COLUMN by distance", "histogram".
struct DrawnFigure {
  std::vector<std::filesystem::path> files;  ///< .svg, .pdf, .png, or .json for the data
  std::vector<std::string> panels;
  std::size_t columns = 2;           ///< panels in a row
  double width = 3.5, height = 2.8;  ///< of a panel [in]
  double font = 8.0;                 ///< [pt]
};

/// Figures of the same curves.
struct FigureData {
  std::string title;
  std::string note;  ///< a line below the legend, or empty
  std::vector<DrawnCurve> curves;
  std::vector<DrawnFigure> figures;
};

/// Draws all of them in one process. Returns the SVG texts of the figures without files. Throws
/// InputError if Python or matplotlib is missing, or a file cannot be written.
std::vector<std::string> draw(const std::vector<FigureData>& all);

/// Throws InputError unless the file name ends in .svg, .pdf, .png or .json.
void check_figure_name(const std::filesystem::path& file);

}  // namespace loopbench::harness
