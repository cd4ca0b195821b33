/// Tables 1 to 4: the printed numbers with ours below, row by row.
#pragma once

#include <string>
#include <vector>

#include "harness/article/paper_run.hpp"

namespace loopbench::harness {

/// Markdown, four tables with headings: errors at keyframes of the closed run in every reading, its
/// dense ATE, and the range of the ATE at keyframes over all runs. Rows that are inconsistent as
/// printed, or that use the reference, have a note.
std::string paper_tables(const std::vector<PaperCell>& cells);

}  // namespace loopbench::harness
