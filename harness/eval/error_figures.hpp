/// Pictures of one or several evaluations.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/eval/evaluation_result.hpp"
#include "harness/plot/gnuplot.hpp"

namespace loopbench::harness {

/// A figure with its name: "trajectories", "errors" or "axes".
struct NamedFigure {
  std::string name;
  std::vector<PlotPanel> panels;
  std::size_t columns = 2;
};

/// - trajectories: xy, xz, yz and space, start and end marked, coloured by position error for a
///   single estimate;
/// - errors: position and rotation error over time and over distance, and the histogram of the
///   position error;
/// - axes: x, y, z, roll, pitch and yaw over time, with the complete reference.
/// All estimates have the same reference, whose first pose is the origin of times and distances. An
/// estimate has the same colour in all of them. O(poses).
std::vector<NamedFigure> error_figures(const std::vector<DrawnEvaluation>& all);

/// Size of the figures for a paper.
struct ErrorFigureSize {
  std::vector<double> panel;  ///< width and height [in]; empty: 3.5 in are divided by the columns
  std::size_t columns = 0;    ///< panels in a row; 0: 2 maps, 1 panel of curves
  double font = 7.0;          ///< [pt]
};

/// PREFIX_trajectories.svg and so on, in SVG, PDF and PNG, by default as wide as one column of a
/// paper (3.5 in). `note`: a line in each figure, or empty.
std::vector<FigureFile> error_figure_files(const std::string& prefix,
                                           const std::vector<DrawnEvaluation>& all,
                                           const std::string& note = "",
                                           const ErrorFigureSize& size = {});

}  // namespace loopbench::harness
