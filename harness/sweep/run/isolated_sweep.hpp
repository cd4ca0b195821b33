/// Runs all cells of a sweep in worker processes, so that a crash, hang or memory overrun affects
/// only one cell.
#pragma once

#include <atomic>
#include <functional>

#include "harness/sweep/model/result.hpp"
#include "harness/sweep/run/worker.hpp"

namespace loopbench::harness {

/// Requests of the user to end a sweep early. 0: none; 1: start no more cells; 2: also abandon the
/// running ones.
using StopRequests = std::atomic<int>;

/// Calls `finished` once per cell, in order of completion. Uses `jobs` worker processes (one if the
/// sweep is serial), which run each cell in a copy of themselves, so that nothing of a cell
/// remains. Programs that methods and datasets run have temporary files in a folder that is removed
/// at the end. Cells that exceed the sweep's limits or end their process have the status timeout,
/// out_of_memory or crashed; a sequence that does so while it is loaded gives all its cells that
/// status. If `stop` is 2, running cells are ended with the status interrupted, otherwise they are
/// finished. Call from a process without threads. Throws InputError for a sequence of a built-in
/// dataset that cannot be loaded (the cells of others fail), std::runtime_error if a process cannot
/// be created.
void run_isolated(WorkerContext context,
                  int jobs,
                  const StopRequests& stop,
                  const std::function<void(const CellResult&)>& finished);

}  // namespace loopbench::harness
