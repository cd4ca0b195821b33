#include "harness/execution/isolate/worker_slot.hpp"

#include <fmt/format.h>
#include <poll.h>

#include "harness/execution/isolate/signal_name.hpp"

namespace loopbench::harness {
namespace {

constexpr double kGrace = 5.0;  // [s], for the worker to end loading and a cell at their limits

}  // namespace

void wait_for_workers(const std::vector<WorkerSlot>& slots) {
  std::vector<pollfd> events;
  for (const WorkerSlot& slot : slots) {
    if (!slot.process || slot.jobs.empty()) continue;
    events.push_back({slot.process->socket(), POLLIN, 0});
    events.push_back({slot.process->descriptor(), POLLIN, 0});
  }
  // Also ended by an interrupt, which stops the sweep.
  poll(events.data(), events.size(), ActiveClock::kTick);
}

void end_if_stuck(WorkerSlot& slot, const Limits& limits) {
  const double seconds = slot.clock.seconds();
  if (slot.jobs.empty() || limits.seconds <= 0.0 || slot.is_stuck) return;
  if (seconds <= 2.0 * limits.seconds + kGrace) return;
  slot.is_stuck = true;
  slot.process->kill();
}

CellResult crash_of_worker(const WorkerSlot& slot, const WorkerProcess::End& end) {
  CellResult out;
  if (slot.is_stuck) {
    out.status = Status::timeout;
    out.signal = "SIGKILL";
    out.why = "its worker process was stopped and did not end it at its time limit";
    return out;
  }
  out.status = Status::crashed;
  if (end.signal != 0) out.signal = signal_name(end.signal);
  out.why = end.signal != 0 ? "its worker process was ended by " + out.signal
                            : fmt::format("its worker process exited with code {}", end.exit_code);
  return out;
}

}  // namespace loopbench::harness
