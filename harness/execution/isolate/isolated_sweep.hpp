/// All cells of a sweep in worker processes: a crash, a hang or a flood of memory costs one cell.
#pragma once

#include <atomic>
#include <functional>

#include "harness/catalogue/catalogue.hpp"
#include "harness/model/result.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench {

/// As run_sweep, with `jobs` processes instead of threads (one, pinned to a core, when the sweep is
/// serial), which are used again until one ends by a failure. Cells that went beyond the sweep's
/// limits or ended their process come out as timeout, out_of_memory or crashed. To be called from a
/// process without threads. Throws InputError for a sequence that cannot be loaded,
/// std::runtime_error when no process can be had.
void run_isolated(const Sweep& sweep,
                  const std::vector<Cell>& cells,
                  const Catalogue& catalogue,
                  const DataRoot& root,
                  int jobs,
                  const std::atomic<bool>& stop,
                  const std::function<void(const CellResult&)>& finished);

}  // namespace loopbench
