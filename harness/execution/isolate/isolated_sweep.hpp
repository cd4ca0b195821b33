/// Runs all cells of a sweep in worker processes, so that a crash, hang or memory overrun affects
/// only one cell.
#pragma once

#include <atomic>
#include <functional>

#include "harness/catalogue/catalogue.hpp"
#include "harness/model/result.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// As run_sweep, with `jobs` processes instead of threads (one, pinned to a core, if the sweep is
/// serial), which are reused until one ends by a failure. Cells that exceed the sweep's limits or
/// end their process have the status timeout, out_of_memory or crashed. Call from a process without
/// threads. Throws InputError for a sequence that cannot be loaded, std::runtime_error if a process
/// cannot be created.
void run_isolated(const Sweep& sweep,
                  const std::vector<Cell>& cells,
                  const Catalogue& catalogue,
                  const DataRoot& root,
                  int jobs,
                  const std::atomic<bool>& stop,
                  const std::function<void(const CellResult&)>& finished);

}  // namespace loopbench::harness
