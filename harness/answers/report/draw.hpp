/// Figures, drawn with the Python package (module loopbench.draw, matplotlib); those of stores.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/answers/report/curve.hpp"
#include "harness/sweep/model/record.hpp"
#include "harness/sweep/store/traces.hpp"

namespace loopbench::harness {

inline constexpr std::array kFigureFormats{"svg", "pdf", "png", "pgf"};

/// Options of `plot` and `traj plot`; without a value those of loopbench.draw.
struct FigureOptions {
  std::vector<std::string> style;      ///< style sheets of matplotlib, files or names
  std::vector<std::string> labels;     ///< names of the estimates
  std::string plane;                   ///< xy, xz or yz; empty: the one of the largest extent
  std::vector<double> size;            ///< width and height of a panel [in]
  std::optional<std::size_t> columns;  ///< panels in a row
  std::optional<double> font;          ///< [pt]
  bool script = false;                 ///< also write the data and a Python script that draws them
};

/// The labels, one for each of `names`, or the names themselves without labels. Throws InputError.
std::vector<std::string> labels_of(const FigureOptions& options,
                                   const std::vector<std::string>& names);

/// Panels: "plane", "xy", "xz", "yz", "xyz" (space), "COLUMN by time", "COLUMN by distance",
/// "histogram"; of scores kScorePanels.
struct DrawnFigure {
  std::vector<std::filesystem::path> files;  ///< the same name with suffixes of kFigureFormats
  std::vector<std::string> panels;
  FigureOptions options;
};

/// The files of a figure and its script, one per line.
std::string file_list(const DrawnFigure& figure);

/// Figures of the same curves.
struct FigureData {
  std::string title;
  std::string note;  ///< a line below the title, or empty
  std::vector<DrawnCurve> curves;
  std::string scores;  ///< JSON for kScorePanels, see harness/python/loopbench/scores.py; or empty
  std::vector<DrawnFigure> figures;
};

/// Draws all of them in one process. Throws InputError if Python or matplotlib is missing, or a
/// file cannot be written.
void draw(const std::vector<FigureData>& all);

/// Whether the file name ends in one of kFigureFormats.
bool is_figure_name(const std::filesystem::path& file);

/// The name, with .pdf added unless it ends in one of kFigureFormats.
std::filesystem::path figure_name(std::filesystem::path name);

/// Ratios to the baseline with intervals; error against time; runs of each sequence; time and
/// memory over a swept size.
inline constexpr std::array kScorePanels{"ratio", "time", "boxes", "growth"};

/// Names of panels: trajectories in the plane of the largest extent ("plane"), in "xy", "xz", "yz"
/// and in space ("xyz"); errors "x", "y", "z" [m] and "angle" [deg] along the path; kScorePanels.
const std::vector<std::string>& panel_names();

/// The panels of panel_names() that show trajectories, or else errors, as panels of a DrawnFigure.
std::vector<std::string> figure_panels(const std::vector<std::string>& names, bool of_errors);

/// Curves for one sequence: the reference, and `methods` on its first repeat, which the title
/// states, in their order; methods without a trace are skipped. The style of a method depends on
/// its index in `all_methods` of the sweep, so that it is the same in every figure. No curves
/// without a trace.
FigureData sequence_figure_data(const std::vector<CellRow>& cells,
                                Traces& traces,
                                const std::string& sequence,
                                const std::vector<std::string>& methods,
                                const std::vector<std::string>& all_methods);

/// "closed, 180 keyframes" -> "closed_180_keyframes": a safe file name.
std::string file_stem(const std::string& label);

}  // namespace loopbench::harness
