/// Tables 1 to 4: the printed numbers with ours beneath, row by row.
#pragma once

#include <string>
#include <vector>

#include "harness/article/paper_run.hpp"

namespace loopbench {

/// Markdown, four tables with a heading each; rows that cannot be true as printed say why.
std::string paper_tables(const std::vector<PaperCell>& cells);

}  // namespace loopbench
