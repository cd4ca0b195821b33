/// All cells of a sweep on several threads; the results do not depend on how many.
#pragma once

#include <atomic>
#include <functional>

#include "harness/execution/run/sequences.hpp"
#include "harness/model/result.hpp"

namespace loopbench {

/// Calls `finished` once per cell, one call at a time, in order of completion. Sequences that
/// cannot be loaded end the sweep before its first cell (InputError). Stops early, leaving the
/// remaining cells out, when `stop` becomes true. `jobs` >= 1.
void run_sweep(const Sweep& sweep,
               const std::vector<Cell>& cells,
               const Catalogue& catalogue,
               Sequences& sequences,
               int jobs,
               const std::atomic<bool>& stop,
               const std::function<void(const CellResult&)>& finished);

}  // namespace loopbench
