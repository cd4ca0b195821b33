#include "harness/execution/isolate/isolated_sweep.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <map>

#include "harness/execution/isolate/cell_child.hpp"
#include "harness/execution/isolate/cell_queue.hpp"
#include "harness/execution/isolate/kept_metadata.hpp"
#include "harness/execution/isolate/killed_cells.hpp"
#include "harness/execution/isolate/subreaper.hpp"
#include "harness/execution/isolate/unpack_answer.hpp"
#include "harness/execution/isolate/worker_slot.hpp"
#include "harness/execution/run/check_output.hpp"
#include "harness/execution/run/oracle_method.hpp"
#include "harness/external/external_datasets.hpp"
#include "harness/external/external_methods.hpp"
#include "harness/text/print_error.hpp"

namespace loopbench::harness {
namespace {

class IsolatedSweep {
 public:
  IsolatedSweep(const WorkerContext& context,
                int jobs,
                const StopRequests& stop,
                const std::function<void(const CellResult&)>& finished)
      : context_(context),
        stop_(stop),
        finished_(finished),
        queue_(context.cells),
        metadata_(context.cells.size()),
        slots_(context.sweep.serial ? 1 : static_cast<std::size_t>(jobs)),
        core_(context.sweep.serial ? last_core() : -1) {}

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
      const auto is_done = [](const WorkerSlot& slot) { return slot.jobs.empty(); };
      if (std::ranges::all_of(slots_, is_done)) return;
      wait_for_workers(slots_, context_.sweep.limits.memory > 0);
      for (WorkerSlot& slot : slots_) {
        if (!slot.process) continue;
        const bool has_ended = slot.process->has_ended();  // first: then all answers are there
        slot.process->receive(slot.bytes);
        read_answers(slot);
        if (has_ended) {
          reap(slot);
        } else {
          apply_limits(slot, context_.sweep.limits);
        }
      }
      if (stop_ > 1) return abandon();
    }
  }

  /// One running and one queued job per worker, so that a worker does not wait for the sweep; only
  /// one job if nothing else may run at the same time.
  void fill(WorkerSlot& slot) {
    const std::size_t depth = context_.sweep.serial ? 1 : 2;
    while (slot.jobs.size() < depth && stop_ == 0) {
      std::optional<Job> job;
      if (!loads_.empty()) {
        // One each, so that the other workers load their sequences in parallel.
        if (!slot.jobs.empty()) return;
        job = loads_.front();
        loads_.pop_front();
        slot.group = queue_.group_of(job->cell);
      } else if (loads_done_) {
        job = next_cell(slot);
      }
      if (!job) return;
      if (!slot.process) {
        slot.process = std::make_unique<WorkerProcess>(context_, core_);
        slot.step = 0;
        slot.ended_by_limit = 0;
      }
      if (slot.jobs.empty()) slot.clock.restart();
      slot.jobs.push_back(*job);
      slot.process->send(*job);
    }
  }

  /// The next cell whose sequence can be loaded; the others get the reason why theirs could not.
  std::optional<Job> next_cell(WorkerSlot& slot) {
    while (const auto cell = queue_.next(slot.group)) {
      const auto failure = load_failures_.find(queue_.group_of(*cell));
      if (failure == load_failures_.end()) return Job{*cell, false};
      finish(failure->second, *cell);
    }
    return std::nullopt;
  }

  void read_answers(WorkerSlot& slot) {
    constexpr const char* kDamage = "its worker process sent a damaged message";
    if (slot.is_lost) return slot.bytes.clear();
    std::size_t at = 0;
    for (;;) {
      Header header;
      if (slot.bytes.size() - at < sizeof header) break;
      std::memcpy(&header, slot.bytes.data() + at, sizeof header);
      const bool is_expected =
          header.is_valid() && !slot.jobs.empty() && header.cell == slot.jobs.front().cell;
      if (!is_expected || slot.process->has_stray_bytes()) return give_up(slot, kDamage);
      if (header.size > slot.bytes.size() - at - sizeof header) break;
      const std::string_view body(slot.bytes.data() + at + sizeof header, header.size);
      if (!take(slot, header, body)) return give_up(slot, kDamage);
      at += sizeof header + header.size;
    }
    slot.bytes.erase(0, at);
    if (slot.process->has_stray_bytes()) give_up(slot, kDamage);
  }

  /// Takes an answer to the first job. False for invalid ones, which only a corrupted worker sends.
  bool take(WorkerSlot& slot, const Header& header, std::string_view body) {
    if (header.kind == Header::Kind::cannot_load)
      fail_to_load(slot.jobs.front(), std::string(body));
    if (header.kind == Header::Kind::cannot_run) {
      throw std::runtime_error("cannot create a process for a cell: " + std::string(body));
    }
    if (header.kind == Header::Kind::loaded) {
      auto metadata = std::make_shared<SequenceMetadata>();
      if (!unpack_answer(body, *metadata)) return false;
      metadata_.keep(queue_.group_of(header.cell), dataset_of(header.cell).label, metadata);
      return true;
    }
    if (header.kind == Header::Kind::result) {
      CellResult result;
      if (!unpack_answer(body, result) || !is_valid(result, context_.sweep)) {
        result = {};
        result.status = Status::crashed;
        result.why = "its result is damaged: it wrote over its memory";
        set_conditions(result, header.cell);
      }
      if (result.status == Status::out_of_memory) {
        slot.ended_by_limit = slot.process->ended_by_limit();
      }
      if (result.status == Status::crashed && killed_.runs_again(header.cell, result.signal)) {
        queue_.requeue(header.cell);
      } else {
        finish(result, header.cell);
      }
    }
    slot.jobs.pop_front();
    return true;
  }

  const DatasetChoice& dataset_of(std::size_t cell) const {
    return context_.sweep.datasets[context_.cells[cell].dataset];
  }

  /// A wrong file name ends the sweep before anything runs; a failure of a program or plugin costs
  /// the cells of its sequence.
  void fail_to_load(const Job& job, const std::string& why) {
    const DatasetChoice& choice = dataset_of(job.cell);
    const std::string& name = choice.dataset.name;
    const bool is_foreign =
        name == kCommandDataset || !plugin_version(context_.catalogue, "dataset", name).empty();
    if (!is_foreign) throw InputError(why);
    CellResult& result = load_failures_[queue_.group_of(job.cell)];
    result.status = Status::failed;
    result.why = stored_reason("dataset '" + choice.label + "': " + why);
    set_conditions(result, job.cell);
    if (!job.only_load) finish(result, job.cell);
  }

  /// What a cell without an answer has in common with the others.
  void set_conditions(CellResult& result, std::size_t cell) const {
    const Sweep& sweep = context_.sweep;
    result.worker = {true, sweep.serial, sweep.serial};
    result.oracle_method =
        uses_reference(sweep.methods[context_.cells[cell].method], context_.catalogue);
  }

  void finish(CellResult result, std::size_t cell) {
    const std::size_t group = queue_.group_of(cell);
    result.cell = context_.cells[cell];
    result.metadata = metadata_.of(group);
    flag_trained_on_evaluated(result, context_.sweep);
    if (stop_ > 0) KilledCells::set_interrupted(result);
    if (queue_.finish(cell)) metadata_.drop(group);
    finished_(result);
  }

  /// Handles the end of a worker: sets the result of what it did and requeues its other jobs.
  void reap(WorkerSlot& slot) {
    const bool is_lost = std::exchange(slot.is_lost, false);
    const bool idle = slot.is_idle();
    const bool loading = slot.is_loading();
    const bool by_limit = !loading && slot.process->ended_by_limit() > slot.ended_by_limit;
    const WorkerProcess::End end = slot.process->end();
    slot.process.reset();
    slot.bytes.clear();
    end_strays_of_workers();
    std::deque<Job> jobs = std::exchange(slot.jobs, {});
    std::optional<CellResult> result = std::exchange(slot.verdict, std::nullopt);
    if (jobs.empty()) return;
    const Job first = jobs.front();
    // Otherwise it was killed after its last answer, or lost before it got the job.
    const bool is_to_blame = is_lost ? result.has_value() : !idle || !result;
    if (is_to_blame) jobs.pop_front();
    for (auto job = jobs.rbegin(); job != jobs.rend(); ++job) requeue(*job);
    if (!is_to_blame) return;
    if (!result) {
      result = crash_of_worker(end, loading, by_limit);
      if (!by_limit && killed_.runs_again(first.cell, result->signal)) return requeue(first);
    }
    set_conditions(*result, first.cell);
    if (loading || (is_lost && first.only_load))
      load_failures_[queue_.group_of(first.cell)] = *result;
    if (!first.only_load) finish(*result, first.cell);
  }

  void end_strays_of_workers() const {
    std::vector<pid_t> workers;
    for (const WorkerSlot& slot : slots_) {
      if (slot.process) workers.push_back(slot.process->process());
    }
    reaper_.end_strays_except(workers);
  }

  void requeue(const Job& job) {
    if (job.only_load) return loads_.push_front(job);
    queue_.requeue(job.cell);
  }

  /// Ends all workers; cells that they are running are interrupted.
  void abandon() {
    for (WorkerSlot& slot : slots_) {
      if (!slot.process || slot.jobs.empty()) continue;
      const bool runs = !slot.is_idle() && !slot.is_loading();
      const double seconds = slot.seconds();
      const std::size_t cell = slot.jobs.front().cell;  // what the worker reports may be damaged
      slot.process.reset();
      slot.jobs.clear();
      if (!runs) continue;
      CellResult result;
      result.status = Status::interrupted;
      result.why = fmt::format("abandoned after {:.1f} s by a second interrupt", seconds);
      set_conditions(result, cell);
      finish(result, cell);
    }
    loads_.clear();
  }

  const WorkerContext& context_;
  const StopRequests& stop_;
  const std::function<void(const CellResult&)>& finished_;
  CellQueue queue_;
  KilledCells killed_;
  std::deque<Job> loads_;
  bool loads_done_ = false;
  KeptMetadata metadata_;
  /// By group. Not an entry for every group: cells are forked from processes with a copy of this,
  /// and a fork takes time for all memory in use.
  std::map<std::size_t, CellResult> load_failures_;
  Subreaper reaper_;  ///< ends strays after the workers
  std::vector<WorkerSlot> slots_;
  int core_;
};

}  // namespace

void run_isolated(const Sweep& sweep,
                  const std::vector<Cell>& cells,
                  const Catalogue& catalogue,
                  const DataRoot& root,
                  int jobs,
                  const SandboxOptions& sandbox,
                  const StopRequests& stop,
                  const std::function<void(const CellResult&)>& finished) {
  const std::unique_ptr<const ScratchFolder> scratch = scratch_for_programs(sweep);
  SandboxOptions options = sandbox;
  if (scratch) options.pid_namespace = false;  // supervisors of programs use numbers in /proc
  if (scratch && options.enabled && !has_bubblewrap()) {
    print_error("loopbench: bubblewrap (bwrap) does not work here: programs can read all files\n");
  }
  const WorkerContext context{sweep, cells, catalogue, root, options};
  IsolatedSweep(context, jobs, stop, finished).run();
}

}  // namespace loopbench::harness
