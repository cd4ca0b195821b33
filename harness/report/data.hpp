/// Data for the report's figures, as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "harness/report/content.hpp"

namespace loopbench::harness {

/// {methods, styles, usual, oracle, sequences, baseline, statistics, kinds, cells}: every score of
/// every cell to five digits. styles: {color, dash} of each method as in `plot`; usual: indices of
/// the methods that are shown first. A cell is {s, m, n, st, ms, v}: indices of its sequence and
/// method, repeat, status, time [ms], and for each kind null or its statistics.
nlohmann::json scores_json(const ReportContent& content);

/// Amount of trace data in the report.
struct Thinning {
  std::size_t points = 0;   ///< maximum per cell
  std::size_t repeats = 1;  ///< of each sequence, the first ones
};

/// As many repeats as allow kGoodPoints per cell (harness/report/drawn.cpp), and as many points as
/// take about `bytes`.
Thinning initial_thinning(const ReportContent& content, std::size_t bytes);

/// Reduces to about `share` of the bytes: points down to kFewestPoints, then repeats, then points
/// down to kLeastPoints. False if no further reduction is possible.
bool reduce(Thinning& thinning, double share);

/// {points, sequences, grids, cells} from the traces. Sequences: reference, and closures by repeat.
/// Cells: grid, errors, and sections of the path; the evaluation times of a cell are in its grid,
/// which cells share.
nlohmann::json traces_json(const ReportContent& content, const Thinning& thinning);

/// [{kind, all, b, e, names, w}], a list of sections for each kind: begin and end relative to
/// `origin` [s], and indices into `names` of the choices. At most kMostSections per kind.
nlohmann::json sections_json(const std::vector<methods::Section>& sections, double origin);

/// Maximum number of poses drawn per cell if `cells` share `bytes`.
std::size_t points_of_a_cell(std::size_t cells, std::size_t bytes);

}  // namespace loopbench::harness
