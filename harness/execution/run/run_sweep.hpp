/// Runs all cells of a sweep on several threads; results do not depend on the number of threads.
#pragma once

#include <functional>

#include "harness/execution/run/sequences.hpp"
#include "harness/execution/run/stop_requests.hpp"
#include "harness/model/result.hpp"

namespace loopbench::harness {

/// Calls `finished` once per cell, serialised, in order of completion. Throws InputError before the
/// first cell if a sequence cannot be loaded. Starts no more cells when `stop` is not 0. `jobs`
/// >= 1.
void run_sweep(const Sweep& sweep,
               const std::vector<Cell>& cells,
               const Catalogue& catalogue,
               Sequences& sequences,
               int jobs,
               const StopRequests& stop,
               const std::function<void(const CellResult&)>& finished);

}  // namespace loopbench::harness
