/// Figures of one or several evaluations.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/eval/drawn_sequences.hpp"
#include "harness/report/draw.hpp"

namespace loopbench::harness {

/// - trajectories: xy, xz, yz and space, start and end marked, coloured by position error for a
///   single estimate;
/// - errors: position and rotation error over time and over distance, and the histogram of the
///   position error;
/// - axes: x, y, z, roll, pitch and yaw over time, with the complete reference.
inline constexpr std::array kErrorFigures{"trajectories", "errors", "axes"};

/// Size of the figures for a paper.
struct ErrorFigureSize {
  std::vector<double> panel;  ///< width and height [in]; empty: 3.5 in are divided by the columns
  std::size_t columns = 0;    ///< panels in a row; 0: 2 maps, 1 panel of curves
  double font = 7.0;          ///< [pt]
};

/// The curves of estimates of one reference, without figures.
FigureData figure_data(const DrawnRuns& runs);

/// kErrorFigures as PREFIX_NAME.svg, .pdf and .png, by default as wide as one column of a paper.
std::vector<DrawnFigure> figures_for_paper(const std::string& prefix, const ErrorFigureSize& size);

/// kErrorFigures without files, for a page.
std::vector<DrawnFigure> figures_for_page();

}  // namespace loopbench::harness
