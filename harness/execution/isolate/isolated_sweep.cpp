#include "harness/execution/isolate/isolated_sweep.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

#include "harness/catalogue/loading.hpp"
#include "harness/execution/isolate/cell_queue.hpp"
#include "harness/execution/isolate/pack_result.hpp"
#include "harness/execution/isolate/worker_process.hpp"
#include "harness/execution/run/oracle_method.hpp"

namespace loopbench::harness {
namespace {

constexpr int kMemoryWatch = 20;  // [ms], between memory checks of the workers

/// The highest core this process may use, since the first ones handle most interrupts.
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

std::string signal_name(int signal) {
  const char* name = sigabbrev_np(signal);
  return name == nullptr ? "signal " + std::to_string(signal) : "SIG" + std::string(name);
}

/// A worker, its unanswered jobs in order, and the answers received so far.
struct WorkerSlot {
  std::unique_ptr<WorkerProcess> process;
  std::deque<Job> jobs;
  std::string bytes;
  std::optional<std::size_t> group;   ///< of its last cell, see CellQueue
  std::optional<CellResult> verdict;  ///< the reason why the sweep killed it, for its current cell
};

class IsolatedSweep {
 public:
  IsolatedSweep(const WorkerContext& context,
                int jobs,
                const std::atomic<bool>& stop,
                const std::function<void(const CellResult&)>& finished)
      : context_(context),
        stop_(stop),
        finished_(finished),
        queue_(context.cells),
        metadata_(context.cells.size()),
        slots_(context.sweep.serial ? 1 : static_cast<std::size_t>(jobs)),
        pinned_(context.sweep.serial ? last_core() : -1) {}

  void run() {
    // Load all sequences first, so that a wrong path in the last dataset is reported immediately.
    for (const std::size_t cell : queue_.first_of_datasets()) loads_.push_back({cell, true});
    work();
    loads_done_ = true;
    work();
  }

 private:
  /// Runs until all jobs are assigned and answered.
  void work() {
    for (;;) {
      for (WorkerSlot& slot : slots_) fill(slot);
      if (std::ranges::all_of(slots_, [](const WorkerSlot& slot) { return slot.jobs.empty(); }))
        return;
      wait();
      for (WorkerSlot& slot : slots_) {
        if (!slot.process) continue;
        const bool alive = slot.process->receive(slot.bytes);
        read_answers(slot);
        if (alive) {
          watch(slot);
        } else {
          reap(slot);
        }
      }
    }
  }

  /// One running and one queued job per worker, so that a worker does not wait for the sweep; only
  /// one job if nothing else may run at the same time.
  void fill(WorkerSlot& slot) {
    const std::size_t depth = context_.sweep.serial ? 1 : 2;
    while (slot.jobs.size() < depth && !stop_) {
      std::optional<Job> job;
      if (!loads_.empty()) {
        // One each, so that the other workers load their sequences in parallel.
        if (!slot.jobs.empty()) return;
        job = loads_.front();
        loads_.pop_front();
        slot.group = queue_.group_of(job->cell);
      } else if (loads_done_) {
        const auto cell = queue_.next(slot.group);
        if (cell) job = Job{*cell, false};
      }
      if (!job) return;
      if (!slot.process) slot.process = std::make_unique<WorkerProcess>(context_, pinned_);
      slot.jobs.push_back(*job);
      slot.process->send(*job);
    }
  }

  /// Waits until a worker answers or a limit can be reached.
  void wait() {
    std::vector<pollfd> sockets;
    int longest = -1;  // [ms]
    const auto at_most = [&](std::int64_t milliseconds) {
      const int bound = static_cast<int>(std::clamp<std::int64_t>(milliseconds, 1, 60000));
      longest = longest < 0 ? bound : std::min(longest, bound);
    };
    for (const WorkerSlot& slot : slots_) {
      if (!slot.process || slot.jobs.empty()) continue;
      sockets.push_back({slot.process->socket(), POLLIN, 0});
      const Limits& limits = context_.sweep.limits;
      if (limits.memory > 0) at_most(kMemoryWatch);
      if (limits.seconds > 0.0) {
        const bool idle = slot.process->shared_status().job == SharedStatus::kIdle;
        const auto left = 1e3 * limits.seconds - (idle ? 0.0 : busy_for(slot) * 1e3);
        at_most(static_cast<std::int64_t>(std::min(left, 60000.0)) + 1);
      }
    }
    poll(sockets.data(), sockets.size(), longest);  // also ended by an interrupt, which sets `stop`
  }

  static double busy_for(const WorkerSlot& slot) {
    return 1e-9 * static_cast<double>(steady_nanoseconds() - slot.process->shared_status().since);
  }

  /// Kills a worker that exceeds a limit.
  void watch(WorkerSlot& slot) {
    const SharedStatus& shared_status = slot.process->shared_status();
    const std::uint64_t job = shared_status.job;
    if (slot.verdict || job == SharedStatus::kIdle) return;
    if (job >= context_.cells.size()) return slot.process->kill();  // the worker wrote over it
    const char* doing = shared_status.loading ? "loading its sequence" : "the cell";
    const Limits& limits = context_.sweep.limits;
    CellResult verdict;
    verdict.cell = context_.cells[job];
    if (limits.seconds > 0.0 && busy_for(slot) > limits.seconds) {
      verdict.status = Status::timeout;
      verdict.why = fmt::format("{} exceeded the time limit of {} s", doing, limits.seconds);
    } else if (const std::int64_t size = limits.memory > 0 ? slot.process->resident_memory() : 0;
               size > limits.memory) {
      verdict.status = Status::out_of_memory;
      verdict.why = fmt::format("{} grew to {} bytes, limit {}", doing, size, limits.memory);
    } else {
      return;
    }
    verdict.signal = "SIGKILL";
    slot.verdict = verdict;
    slot.process->kill();
  }

  void read_answers(WorkerSlot& slot) {
    std::size_t at = 0;
    for (;;) {
      Header header;
      if (slot.bytes.size() - at < sizeof header) break;
      std::memcpy(&header, slot.bytes.data() + at, sizeof header);
      if (header.size > slot.bytes.size() - at - sizeof header) break;
      const std::string_view body(slot.bytes.data() + at + sizeof header, header.size);
      if (!take(slot, header, body)) {
        // It has corrupted its own memory, so its other answers are not reliable.
        slot.process->kill();
        at = slot.bytes.size();
        break;
      }
      at += sizeof header + header.size;
    }
    slot.bytes.erase(0, at);
  }

  /// False for invalid messages, which only a corrupted worker sends.
  bool take(WorkerSlot& slot, const Header& header, std::string_view body) {
    if (slot.jobs.empty() || header.cell != slot.jobs.front().cell) return false;
    if (header.kind == Header::Kind::cannot_load) throw InputError(std::string(body));
    if (header.kind == Header::Kind::loaded) {
      auto metadata = std::make_shared<SequenceMetadata>();
      if (!unpacked(body, *metadata)) return false;
      keep(header.cell, std::move(metadata));
      return true;
    }
    if (header.kind == Header::Kind::result) {
      CellResult result;
      if (!unpacked(body, result)) return false;
      result.cell = context_.cells[header.cell];
      finish(result, header.cell);
    }
    slot.jobs.pop_front();
    return true;
  }

  template <class T>
  static bool unpacked(std::string_view body, T& out) {
    try {
      Unpacker unpack(body);
      unpack(out);
      return true;
    } catch (const std::runtime_error&) {
      return false;
    }
  }

  void keep(std::size_t cell, std::shared_ptr<const SequenceMetadata> metadata) {
    std::shared_ptr<const SequenceMetadata>& kept = metadata_[queue_.group_of(cell)];
    if (kept && !std::ranges::equal(
                    kept->inputs, metadata->inputs, {}, &InputFile::hash, &InputFile::hash)) {
      throw InputError(metadata->inputs.front().path +
                       " or a file read with it changed during the run");
    }
    if (kept) return;
    // Every worker loads its own copy, but the notes are printed once.
    print_notes(context_.sweep.datasets[context_.cells[cell].dataset].label, metadata->notes);
    kept = std::move(metadata);
  }

  void finish(CellResult& result, std::size_t cell) {
    const std::size_t group = queue_.group_of(cell);
    result.metadata = metadata_[group];
    flag_trained_on_evaluated(result, context_.sweep);
    if (queue_.finish(cell)) metadata_[group].reset();  // no longer needed
    finished_(result);
  }

  /// Handles the end of a worker: sets the result of its current cell and requeues the others.
  void reap(WorkerSlot& slot) {
    const WorkerProcess::End end = slot.process->end();
    const bool loading = slot.process->shared_status().loading;
    const bool idle = slot.process->shared_status().job == SharedStatus::kIdle;
    slot.process.reset();
    slot.bytes.clear();
    std::deque<Job> jobs = std::exchange(slot.jobs, {});
    const std::optional<CellResult> verdict = std::exchange(slot.verdict, std::nullopt);
    if (jobs.empty()) return;
    const Job first = jobs.front();
    const Cell& cell = context_.cells[first.cell];
    if (verdict && verdict->cell.index != cell.index) {
      requeue(jobs);  // it had answered everything
      return;
    }
    jobs.pop_front();
    requeue(jobs);
    if (first.only_load) return;  // each of its cells will report the failure
    CellResult result = verdict ? *verdict : CellResult{};
    result.cell = cell;
    if (!verdict) {
      result.status = Status::crashed;
      if (end.signal != 0) result.signal = signal_name(end.signal);
      result.why = end.signal != 0 ? "ended by " + result.signal
                                   : fmt::format("exited, exit code {}", end.exit_code);
      if (end.signal == 9) result.why += ", not by this program (system out of memory?)";
      if (loading && !idle) result.why += ", while loading its sequence";
    }
    result.worker = {true, context_.sweep.serial, context_.sweep.serial};
    result.oracle_method = uses_reference(context_.sweep.methods[cell.method], context_.catalogue);
    finish(result, first.cell);
  }

  void requeue(const std::deque<Job>& jobs) {
    for (auto job = jobs.rbegin(); job != jobs.rend(); ++job) {
      if (!job->only_load) queue_.requeue(job->cell);
    }
  }

  const WorkerContext& context_;
  const std::atomic<bool>& stop_;
  const std::function<void(const CellResult&)>& finished_;
  CellQueue queue_;
  std::deque<Job> loads_;
  bool loads_done_ = false;
  std::vector<std::shared_ptr<const SequenceMetadata>> metadata_;  ///< by group
  std::vector<WorkerSlot> slots_;
  int pinned_;
};

}  // namespace

void run_isolated(const Sweep& sweep,
                  const std::vector<Cell>& cells,
                  const Catalogue& catalogue,
                  const DataRoot& root,
                  int jobs,
                  const std::atomic<bool>& stop,
                  const std::function<void(const CellResult&)>& finished) {
  const WorkerContext context{sweep, cells, catalogue, root};
  IsolatedSweep(context, jobs, stop, finished).run();
}

}  // namespace loopbench::harness
