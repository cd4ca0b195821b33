/// The numbers that a report draws, as JSON.
#pragma once

#include <string>

#include "harness/report/content.hpp"

namespace loopbench {

/// {methods, oracle, sequences, baseline, statistics, kinds, cells}: every score of every cell to
/// five digits. A cell is {s, m, n, st, ms, v}: places of its sequence and method, repeat, status,
/// time [ms], and for each kind null or its statistics.
std::string scores_json(const ReportContent& content);

/// What of the traces is drawn.
struct Thinning {
  std::size_t points = 0;   ///< at most, of a cell
  std::size_t repeats = 1;  ///< of each sequence, the first ones
};

/// As many repeats as leave kGoodPoints to a cell (harness/report/drawn.cpp), and as many points as
/// take about `bytes`.
Thinning usual_thinning(const ReportContent& content, std::size_t bytes);

/// To about `share` of the bytes: points down to kFewestPoints, then repeats, then points down to
/// kLeastPoints. False when nothing is left to thin.
bool thin(Thinning& thinning, double share);

/// {points, sequences, grids, cells} from the traces. Sequences: reference, and by repeat its
/// closures. Cells: grid, errors, and where the method cut up the way; where a cell was judged
/// stands in its grid, which cells share.
std::string traces_json(const ReportContent& content, const Thinning& thinning);

/// [{kind, all, b, e, names, w}], a list of sections for each kind: begin and end after `origin`
/// [s], and places in `names` of what was chosen. At most kMostSections of a kind.
std::string cut_json(const std::vector<Section>& sections, double origin);

/// The most poses drawn of a cell when `cells` share `bytes`.
std::size_t points_of_a_cell(std::size_t cells, std::size_t bytes);

}  // namespace loopbench
