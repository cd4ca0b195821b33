/// A worker as the sweep uses it: its jobs and its time.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
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
  std::optional<std::size_t> group;   ///< of its last cell, see CellQueue
  std::optional<CellResult> verdict;  ///< the reason why the sweep killed it, without its cell
  bool is_lost = false;    ///< killed because its messages or silence cannot be explained
  std::uint64_t step = 0;  ///< of the shared status, when the clock started
  ActiveClock clock;
  std::int64_t ended_by_limit = 0;  ///< WorkerProcess::ended_by_limit() before the running cell

  /// Time since the worker began what it does [s].
  double seconds() {
    const std::uint64_t now = process->shared_status().step;
    if (std::exchange(step, now) != now) clock.restart();
    return clock.seconds();
  }
  bool is_idle() const { return process->shared_status().job == SharedStatus::kIdle; }
  bool is_loading() const { return !is_idle() && process->shared_status().loading; }
};

/// Waits until a worker answers or ends, or a limit can be reached, also of the memory of a loading
/// worker if `watches_memory`.
void wait_for_workers(const std::vector<WorkerSlot>& slots, bool watches_memory);

/// Kills a worker that exceeds a limit while loading, that does not end a cell that does, or that
/// does not begin its job. Sets the verdict.
void apply_limits(WorkerSlot& slot, const Limits& limits);

/// Kills a worker whose messages cannot be used: of damaged ones, no later one is reliable.
void give_up(WorkerSlot& slot, const std::string& why);

/// Result of the cell or sequence of a worker that ended by itself or was killed; `by_limit`: by
/// the memory limit of its control group.
CellResult crash_of_worker(const WorkerProcess::End& end, bool loading, bool by_limit);

}  // namespace loopbench::harness
