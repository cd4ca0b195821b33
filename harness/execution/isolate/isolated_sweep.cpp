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
      wait_for_workers(slots_);
      for (WorkerSlot& slot : slots_) {
        if (!slot.process) continue;
        const bool has_ended = slot.process->has_ended();  // first: then all answers are there
        slot.process->receive(slot.bytes);
        read_answers(slot);
        if (has_ended) {
          reap(slot);
        } else {
          end_if_stuck(slot, context_.sweep.limits);
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
        slot.is_stuck = false;
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
    std::size_t at = 0;
    for (;;) {
      Header header;
      if (slot.bytes.size() - at < sizeof header) break;
      std::memcpy(&header, slot.bytes.data() + at, sizeof header);
      if (header.size > slot.bytes.size() - at - sizeof header) break;
      take(slot, header, std::string_view(slot.bytes).substr(at + sizeof header, header.size));
      at += sizeof header + header.size;
    }
    slot.bytes.erase(0, at);
  }

  /// Takes an answer to the first job.
  void take(WorkerSlot& slot, const Header& header, std::string_view body) {
    const Job job = slot.jobs.front();
    switch (header.kind) {
      case Header::Kind::cannot_run:
        throw std::runtime_error("cannot create a process for a cell: " + std::string(body));
      case Header::Kind::loaded: {
        auto metadata = std::make_shared<SequenceMetadata>();
        if (!unpack_answer(body, *metadata)) throw std::runtime_error("metadata are damaged");
        metadata_.keep(queue_.group_of(job.cell), dataset_of(job.cell).label, metadata);
        slot.clock.restart();  // now for the cell
        return;
      }
      case Header::Kind::missing_part:
        throw MissingPart(std::string(body));
      case Header::Kind::cannot_load:
        fail_to_load(job, std::string(body));
        break;
      case Header::Kind::load_failed:
        take_failure(job, body);
        break;
      case Header::Kind::result:
        take_result(job, body);
        break;
      case Header::Kind::only_loaded:
        break;
    }
    slot.jobs.pop_front();
    slot.clock.restart();
  }

  void take_result(const Job& job, std::string_view body) {
    CellResult result;
    if (!unpack_answer(body, result) || !is_valid(result, context_.sweep)) {
      result = {};
      result.status = Status::crashed;
      result.why = "its result is damaged: it wrote over its memory";
      set_conditions(result, job.cell);
    }
    if (result.status == Status::crashed && killed_.runs_again(job.cell, result.signal)) {
      queue_.requeue(job.cell);
    } else {
      finish(result, job.cell);
    }
  }

  /// Loading exceeded a limit or ended its process.
  void take_failure(const Job& job, std::string_view body) {
    CellResult result;
    if (!unpack_answer(body, result)) throw std::runtime_error("a failure is damaged");
    if (result.status == Status::crashed && killed_.runs_again(job.cell, result.signal)) {
      return requeue(job);
    }
    set_conditions(result, job.cell);
    load_failures_[queue_.group_of(job.cell)] = result;
    if (!job.only_load) finish(result, job.cell);
  }

  const DatasetChoice& dataset_of(std::size_t cell) const {
    return context_.sweep.datasets[context_.cells[cell].dataset];
  }

  /// A wrong file name ends the sweep before anything runs; a failure of a program or plugin costs
  /// the cells of its sequence.
  void fail_to_load(const Job& job, const std::string& why) {
    const DatasetChoice& choice = dataset_of(job.cell);
    if (!has_foreign_code(context_.catalogue, choice.dataset)) throw InputError(why);
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

  /// Handles the end of a worker: it runs no foreign code, so something outside ended it. Its first
  /// job is done once more, then given up; the others are done by the next worker.
  void reap(WorkerSlot& slot) {
    const WorkerProcess::End end = slot.process->end();
    slot.process.reset();
    slot.bytes.clear();
    end_strays_of_workers();
    std::deque<Job> jobs = std::exchange(slot.jobs, {});
    if (jobs.empty()) return;
    const Job first = jobs.front();
    CellResult result = crash_of_worker(slot, end);
    const bool runs_again = !slot.is_stuck && killed_.runs_again(first.cell, result.signal);
    if (!runs_again) jobs.pop_front();
    for (auto job = jobs.rbegin(); job != jobs.rend(); ++job) requeue(*job);
    if (runs_again) return;
    set_conditions(result, first.cell);
    if (first.only_load) {
      load_failures_[queue_.group_of(first.cell)] = result;
    } else {
      finish(result, first.cell);
    }
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
      const double seconds = slot.clock.seconds();
      const Job job = slot.jobs.front();
      slot.process.reset();
      slot.jobs.clear();
      if (job.only_load) continue;
      CellResult result;
      result.status = Status::interrupted;
      result.why = fmt::format("abandoned after {:.1f} s by a second interrupt", seconds);
      set_conditions(result, job.cell);
      finish(result, job.cell);
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
  if (scratch && sandbox.enabled && !has_bubblewrap()) {
    print_error("loopbench: bubblewrap (bwrap) does not work here: programs can read all files\n");
  }
  const WorkerContext context{sweep, cells, catalogue, root, sandbox};
  IsolatedSweep(context, jobs, stop, finished).run();
}

}  // namespace loopbench::harness
