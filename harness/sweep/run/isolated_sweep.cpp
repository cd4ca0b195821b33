#include "harness/sweep/run/isolated_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "harness/sweep/catalogue/command_dataset.hpp"
#include "harness/sweep/catalogue/external_methods.hpp"
#include "harness/sweep/catalogue/loading.hpp"
#include "harness/sweep/process/descendants.hpp"
#include "harness/sweep/run/cell_queue.hpp"
#include "harness/sweep/run/check_output.hpp"
#include "harness/sweep/run/pack.hpp"
#include "harness/sweep/run/worker_process.hpp"
#include "harness/sweep/text/print_error.hpp"

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
        core_(context.sweep.serial ? last_core() : -1),
        longest_(longest_limits(context.sweep)) {}

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
        const bool has_ended =
            slot.process->child().has_ended();  // first: then all answers are there
        slot.process->receive();
        while (const auto answer = slot.process->next_answer()) take(slot, *answer);
        if (has_ended) {
          reap(slot);
        } else {
          end_if_stuck(slot, longest_);
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

  /// Takes an answer to the first job.
  void take(WorkerSlot& slot, const Answer& answer) {
    const Job job = slot.jobs.front();
    slot.clock.restart();
    switch (answer.kind) {
      case Header::Kind::loaded:
        return keep_metadata(job.cell, answer.body);  // the cell comes next
      case Header::Kind::only_loaded:
        break;
      case Header::Kind::failure: {
        Failure failure;
        if (!unpack(answer.body, failure)) throw std::runtime_error("a failure is damaged");
        take_failure(job, failure);
        break;
      }
      case Header::Kind::result: {
        CellResult result;
        if (unpack(answer.body, result) && is_valid(result, context_.sweep)) {
          finish(result, job.cell);
        } else {
          fail(job,
               {Failure::Kind::cell,
                Status::crashed,
                "its result is damaged: it wrote over its memory",
                ""});
        }
        break;
      }
    }
    slot.jobs.pop_front();
  }

  /// Every worker loads its own copy of a sequence, but one metadata is kept, and its notes are
  /// printed once.
  void keep_metadata(std::size_t cell, std::string_view bytes) {
    auto metadata = std::make_shared<SequenceMetadata>();
    if (!unpack(bytes, *metadata)) throw std::runtime_error("metadata are damaged");
    std::shared_ptr<const SequenceMetadata>& kept = metadata_[queue_.group_of(cell)];
    if (kept && !std::ranges::equal(
                    kept->inputs, metadata->inputs, {}, &InputFile::hash, &InputFile::hash)) {
      throw InputError(metadata->inputs.front().path +
                       " or a file read with it changed during the run");
    }
    if (kept) return;
    print_notes(dataset_of(cell).label, metadata->notes);
    kept = std::move(metadata);
  }

  /// A wrong file name ends the sweep before anything runs; a failure of a program or plugin costs
  /// the cells of its sequence.
  void take_failure(const Job& job, Failure failure) {
    const DatasetChoice& choice = dataset_of(job.cell);
    switch (failure.kind) {
      case Failure::Kind::system:
        throw InputError("cannot create a process for a cell: " + failure.why + kMoreProcesses);
      case Failure::Kind::missing_part:
        throw MissingPart(failure.why);
      case Failure::Kind::input_error:
        if (!has_foreign_code(context_.catalogue, choice.dataset)) {
          throw InputError(with_place(failure.why, choice, context_.sweep));
        }
        failure.why = stored_reason("dataset '" + choice.label + "': " + failure.why);
        break;
      case Failure::Kind::cell:
      case Failure::Kind::loading:
        break;
    }
    if (runs_again(job, failure)) return requeue(job);
    fail(job, failure);
  }

  /// Whether the job runs again: the first time that a signal ended it which a scheduler or the
  /// system sends. A scheduler that ends a job sends SIGTERM, later SIGKILL, to all of its
  /// processes in any order, so a sweep can see a cell end before it is ended itself. That is no
  /// result of the method.
  bool runs_again(const Job& job, const Failure& failure) {
    constexpr std::array<std::string_view, 4> kFromOutside{
        "SIGTERM", "SIGKILL", "SIGINT", "SIGHUP"};
    return failure.status == Status::crashed &&
           std::ranges::count(kFromOutside, failure.signal) > 0 && killed_.insert(job.cell).second;
  }

  /// Finishes the cell of a job without a result, and with a sequence that cannot be loaded all its
  /// cells.
  void fail(const Job& job, const Failure& failure) {
    CellResult result;
    result.status = failure.status;
    result.why = failure.why;
    result.signal = failure.signal;
    set_conditions(result, job.cell);
    if (failure.kind != Failure::Kind::cell) load_failures_[queue_.group_of(job.cell)] = result;
    if (!job.only_load) finish(result, job.cell);
  }

  const DatasetChoice& dataset_of(std::size_t cell) const {
    return context_.sweep.datasets[context_.cells[cell].dataset];
  }

  /// What a cell without an answer has in common with the others.
  void set_conditions(CellResult& result, std::size_t cell) const {
    const Sweep& sweep = context_.sweep;
    result.worker = {true, context_.is_alone, sweep.serial};
    result.oracle_method =
        uses_reference(sweep.methods[context_.cells[cell].method], context_.catalogue);
  }

  void finish(CellResult result, std::size_t cell) {
    std::shared_ptr<const SequenceMetadata>& metadata = metadata_[queue_.group_of(cell)];
    result.cell = context_.cells[cell];
    result.metadata = metadata;
    // A request to stop can also have ended a program that the cell runs.
    const bool has_failed = result.status == Status::crashed || result.status == Status::failed;
    if (stop_ > 0 && has_failed) result.status = Status::interrupted;
    if (queue_.finish(cell)) metadata.reset();
    finished_(result);
  }

  /// Handles the end of a worker: it runs no foreign code, so something outside ended it. Its first
  /// job is done once more, then given up; the others are done by the next worker.
  void reap(WorkerSlot& slot) {
    const Failure failure = failure_of_worker(slot);
    slot.process.reset();
    std::vector<pid_t> workers;
    for (const WorkerSlot& other : slots_) {
      if (other.process) workers.push_back(other.process->child().id());
    }
    reaper_.end_strays_except(workers);
    std::deque<Job> jobs = std::exchange(slot.jobs, {});
    if (jobs.empty()) return;
    const Job first = jobs.front();
    const bool is_again = runs_again(first, failure);
    if (!is_again) jobs.pop_front();
    for (auto job = jobs.rbegin(); job != jobs.rend(); ++job) requeue(*job);
    if (!is_again) fail(first, failure);
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
      fail(job,
           {Failure::Kind::cell,
            Status::interrupted,
            fmt::format("abandoned after {:.1f} s by a second interrupt", seconds),
            ""});
    }
    loads_.clear();
  }

  const WorkerContext& context_;
  const StopRequests& stop_;
  const std::function<void(const CellResult&)>& finished_;
  CellQueue queue_;
  std::set<std::size_t> killed_;  ///< cells that ran again, see runs_again()
  std::deque<Job> loads_;
  bool loads_done_ = false;
  /// By group, of sequences whose cells are not finished; null if it was not loaded.
  std::vector<std::shared_ptr<const SequenceMetadata>> metadata_;
  /// By group. Not an entry for every group: cells are forked from processes with a copy of this,
  /// and a fork takes time for all memory in use.
  std::map<std::size_t, CellResult> load_failures_;
  Subreaper reaper_;  ///< ends strays after the workers
  std::vector<WorkerSlot> slots_;
  int core_;
  Limits longest_;
};

}  // namespace

void run_isolated(WorkerContext context,
                  int jobs,
                  const StopRequests& stop,
                  const std::function<void(const CellResult&)>& finished) {
  const std::unique_ptr<const ScratchFolder> scratch = scratch_for_programs(context.sweep);
  const std::string missing = scratch ? missing_protection(context.sandbox) : "";
  if (!missing.empty()) print_error("loopbench: {}\n", missing);
  context.is_alone = context.sweep.serial || jobs == 1;
  IsolatedSweep(context, jobs, stop, finished).run();
}

}  // namespace loopbench::harness
