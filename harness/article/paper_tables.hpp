/// Tables 1 to 4: the printed numbers with ours below, row by row.
#pragma once

#include <string>
#include <vector>

#include "harness/article/paper_run.hpp"

namespace loopbench::harness {

/// Markdown, four tables with headings; rows that are inconsistent as printed have a note.
std::string paper_tables(const std::vector<PaperCell>& cells);

}  // namespace loopbench::harness
