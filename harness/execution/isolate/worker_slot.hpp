/// A worker as the sweep uses it: its jobs and its time.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/execution/isolate/active_clock.hpp"
#include "harness/execution/isolate/worker_process.hpp"
#include "harness/model/result.hpp"

namespace loopbench::harness {

/// A worker, its unanswered jobs in order, and the answers received so far.
struct WorkerSlot {
  std::unique_ptr<WorkerProcess> process;
  std::deque<Job> jobs;
  std::string bytes;
  std::optional<std::size_t> group;  ///< of its last cell, see CellQueue
  ActiveClock clock;                 ///< since its first job became the first
  bool is_stuck = false;             ///< killed because it did not answer
};

/// Waits until a worker answers or ends, at most as long as the clocks of workers allow.
void wait_for_workers(const std::vector<WorkerSlot>& slots);

/// Kills a worker that does not end its cell: one that a cell stopped.
void end_if_stuck(WorkerSlot& slot, const Limits& limits);

/// Result of the first job of a worker that has ended.
CellResult crash_of_worker(const WorkerSlot& slot, const WorkerProcess::End& end);

}  // namespace loopbench::harness
