#include "harness/execution/isolate/cell_child.hpp"

#include <fmt/format.h>
#include <linux/close_range.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

#include "harness/execution/isolate/pack_result.hpp"
#include "harness/execution/isolate/warm_heap.hpp"
#include "harness/execution/isolate/worker_signals.hpp"
#include "harness/execution/run/process_usage.hpp"
#include "harness/execution/run/run_cell.hpp"
#include "harness/execution/sandbox/system_file.hpp"

namespace loopbench::harness {
namespace {

/// Writable memory beyond the limit that a cell may reserve without using it [bytes].
constexpr std::int64_t kReserve = std::int64_t{1} << 30;

constexpr std::size_t kLongestReason = std::size_t{16} << 10;  // [bytes]

/// Pins the process to one core; false if that is not permitted.
bool pin_to(int core) {
  if (core < 0) return false;
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(core), &set);
  return sched_setaffinity(0, sizeof set, &set) == 0;
}

/// Ends growth that is faster than the worker's checks.
void limit_memory(std::int64_t memory) {
  const std::optional<std::int64_t> now = data_memory();
  if (memory <= 0 || !now) return;
  const auto most = static_cast<rlim_t>(*now + memory + kReserve);
  const rlimit both{most, most};
  setrlimit(RLIMIT_DATA, &both);
}

/// Detects a method that exceeded the limit between two checks by the worker.
void apply_memory_limit(const Limits& limits, CellResult& result) {
  if (limits.memory <= 0 || result.added_memory.value_or(0) <= limits.memory) return;
  result.status = Status::out_of_memory;
  result.why =
      fmt::format("the cell grew by {} bytes, limit {}", *result.added_memory, limits.memory);
  result.scores.clear();
  result.trace = {};
}

}  // namespace

int last_core() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 0;
  int last = 0;
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(static_cast<std::size_t>(core), &set)) last = core;
  }
  return last;
}

void connect_streams(int input, int output, std::vector<int> kept) {
  dup2(input, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  std::ranges::sort(kept);
  auto first = static_cast<unsigned>(STDERR_FILENO + 1);
  for (const int descriptor : kept) {
    const auto number = static_cast<unsigned>(descriptor);
    if (descriptor < 0 || number < first) continue;
    if (number > first) close_range(first, number - 1, 0);
    first = number + 1;
  }
  close_range(first, ~0u, 0);
}

void detach_from_worker(pid_t worker, std::int64_t memory) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != worker) _exit(1);  // the worker has ended in the meantime
  setpgid(0, 0);
  restore_default_signals();
  // If the system runs out of memory, it should kill the cell, not the worker or the sweep.
  write_system_file("/proc/self/oom_score_adj", "800");
  limit_memory(memory);
}

void run_cell_and_exit(const CellChild& child) {
  detach_from_worker(child.worker, child.context.sweep.limits.memory);
  const bool is_pinned = pin_to(child.core);
  set_freshly_forked();
  warm_heap();
  const Sweep& sweep = child.context.sweep;
  connect_streams(child.input, child.output, child.kept);
  CellResult result = run_cell(child.cell, sweep, child.sequence, child.context.catalogue);
  result.worker = {true, sweep.serial, is_pinned};
  apply_memory_limit(sweep.limits, result);
  if (result.why.size() > kLongestReason) result.why.resize(kLongestReason);
  Packer pack;
  pack(result);
  const bool is_written = child.area.write(pack.bytes());
  std::fflush(stdout);
  _exit(is_written ? 0 : 1);  // without running the sweep's destructors
}

}  // namespace loopbench::harness
