/// The numbers that a report draws, as JSON.
#pragma once

#include <string>

#include "harness/report/content.hpp"

namespace loopbench {

/// {methods, oracle, sequences, baseline, statistics, kinds, cells}: every score of every cell to
/// five digits. A cell is {s, m, n, st, ms, v}: places of its sequence and method, repeat, status,
/// time [ms], and for each kind null or its statistics.
std::string scores_json(const ReportContent& content);

/// {points, sequences, grids, cells} from the traces of the first repeat of every sequence, thinned
/// so that all together take at most about `bytes`. Sequences: reference and closures. Cells: grid
/// and errors; where a cell was judged stands in its grid, which cells share.
std::string traces_json(const ReportContent& content, std::size_t bytes);

/// The most poses drawn of a cell when `cells` share `bytes`.
std::size_t points_of_a_cell(std::size_t cells, std::size_t bytes);

}  // namespace loopbench
