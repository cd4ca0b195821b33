/// Figures from the traces of a store.
#pragma once

#include <string>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/report/draw.hpp"
#include "harness/store/traces.hpp"

namespace loopbench::harness {

/// Names of panels: trajectories in the plane of the largest extent ("plane"), in "xy", "xz", "yz"
/// and in space ("xyz"); errors "x", "y", "z" [m] and "angle" [deg] along the path.
const std::vector<std::string>& panel_names();

/// The panels of panel_names() that show trajectories, or else errors, as panels of a DrawnFigure.
std::vector<std::string> figure_panels(const std::vector<std::string>& names, bool of_errors);

/// Curves for one sequence: the reference, and `methods` on its first repeat, which the title
/// states, in their order; methods without a trace are skipped. The style of a method depends on
/// its index in `all_methods` of the sweep, so that it is the same in every figure. No curves
/// without a trace.
FigureData sequence_figure_data(const std::vector<CellRecord>& cells,
                                Traces& traces,
                                const std::string& sequence,
                                const std::vector<std::string>& methods,
                                const std::vector<std::string>& all_methods);

/// "closed, 180 keyframes" -> "closed_180_keyframes": a safe file name.
std::string file_stem(const std::string& label);

}  // namespace loopbench::harness
