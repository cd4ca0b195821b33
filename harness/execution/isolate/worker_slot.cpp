#include "harness/execution/isolate/worker_slot.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <csignal>

#include "harness/execution/isolate/process_tree.hpp"
#include "harness/execution/isolate/signal_name.hpp"

namespace loopbench::harness {
namespace {

constexpr int kMemoryWatch = 20;          // [ms], between memory checks of loading workers
constexpr double kGrace = 5.0;            // [s], for the worker to end a cell at its limit
constexpr double kLongestSilence = 60.0;  // [s], of a worker that has a job and is idle

/// Code in its process can have read the job from the socket.
void limit_silence(WorkerSlot& slot, double most) {
  if (slot.seconds() > most + kGrace) give_up(slot, "its worker process stopped answering");
}

}  // namespace

void wait_for_workers(const std::vector<WorkerSlot>& slots, bool watches_memory) {
  std::vector<pollfd> events;
  int longest = ActiveClock::kTick;
  for (const WorkerSlot& slot : slots) {
    if (!slot.process || slot.jobs.empty()) continue;
    events.push_back({slot.process->socket(), POLLIN, 0});
    events.push_back({slot.process->descriptor(), POLLIN, 0});
    if (slot.is_loading() && watches_memory) longest = kMemoryWatch;
  }
  poll(events.data(), events.size(), longest);  // also ended by an interrupt, which stops the sweep
}

void give_up(WorkerSlot& slot, const std::string& why) {
  if (!slot.jobs.empty()) {
    slot.verdict.emplace();
    slot.verdict->status = Status::crashed;
    slot.verdict->signal = "SIGKILL";
    slot.verdict->why =
        why + ": code in it, of a dataset or a library, used descriptors that it did not open";
  }
  slot.is_lost = true;
  slot.process->kill();
}

void apply_limits(WorkerSlot& slot, const Limits& limits) {
  if (slot.verdict || slot.is_lost || slot.jobs.empty()) return;
  if (slot.is_idle()) {
    const bool is_limited = limits.seconds > 0.0 && limits.seconds < kLongestSilence;
    return limit_silence(slot, is_limited ? limits.seconds : kLongestSilence);
  }
  const bool loading = slot.is_loading();
  const double seconds = slot.seconds();
  CellResult verdict;
  verdict.signal = "SIGKILL";
  if (limits.seconds > 0.0 && seconds > limits.seconds + (loading ? 0.0 : kGrace)) {
    verdict.status = Status::timeout;
    verdict.why = fmt::format("{} exceeded the time limit of {} s",
                              loading ? "loading its sequence" : "the cell",
                              limits.seconds);
    if (!loading) verdict.why += ", and its worker did not end it";
    slot.verdict = verdict;
  } else if (loading && limits.memory > 0) {
    const std::int64_t growth = process_memory(std::to_string(slot.process->process())) -
                                slot.process->shared_status().memory;
    if (growth <= limits.memory) return;
    verdict.status = Status::out_of_memory;
    verdict.why =
        fmt::format("loading its sequence grew by {} bytes, limit {}", growth, limits.memory);
    slot.verdict = verdict;
  }
  if (slot.verdict) slot.process->kill();
}

CellResult crash_of_worker(const WorkerProcess::End& end, bool loading, bool by_limit) {
  CellResult out;
  if (by_limit) {
    out.status = Status::out_of_memory;
    out.signal = "SIGKILL";
    out.why = "the kernel killed its worker process at the memory limit of the cell";
    return out;
  }
  out.status = Status::crashed;
  if (end.signal != 0) out.signal = signal_name(end.signal);
  out.why = end.signal != 0 ? "ended by " + out.signal
                            : fmt::format("exited, exit code {}", end.exit_code);
  if (end.signal == SIGKILL) out.why += ", not by this program (system out of memory?)";
  out.why += loading ? ", while loading its sequence" : " (its worker process)";
  return out;
}

}  // namespace loopbench::harness
