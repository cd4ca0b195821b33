/// Time and memory of the methods, as tables.
#pragma once

#include <vector>

#include "harness/model/record.hpp"
#include "harness/tables/table_view.hpp"

namespace loopbench::harness {

/// One row per method: wall and CPU time, memory, iterations. Medians over its finished cells,
/// maximum for memory. No rows for results of files (`eval --store`), which have no times.
TableView costs(const std::vector<CellRecord>& cells);

/// One row per phase and count that a method reports: medians over its cells.
TableView reported(const std::vector<CellRecord>& cells);

}  // namespace loopbench::harness
