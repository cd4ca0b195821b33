#include "harness/sweep/run/worker.hpp"

#include <fmt/format.h>
#include <malloc.h>
#include <sched.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <list>
#include <optional>

#include "datasets/core/error.hpp"
#include "datasets/core/parallel.hpp"
#include "harness/sweep/catalogue/command_dataset.hpp"
#include "harness/sweep/catalogue/external_methods.hpp"
#include "harness/sweep/catalogue/load_sequence.hpp"
#include "harness/sweep/catalogue/server.hpp"
#include "harness/sweep/run/check_output.hpp"
#include "harness/sweep/run/pack.hpp"
#include "harness/sweep/run/run_cell.hpp"
#include "harness/sweep/run/summarise_sequence.hpp"
#include "harness/sweep/run/watched_process.hpp"

namespace loopbench::harness {
namespace {

/// Writes all bytes; false if the other side has closed.
bool send_all(int socket, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = send(socket, at, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool receive_job(int socket, Job& job) {
  for (;;) {
    const ssize_t got = recv(socket, &job, sizeof job, MSG_WAITALL);
    if (got < 0 && errno == EINTR) continue;
    return got == sizeof job;
  }
}

/// Pins the process to one core; false if that is not permitted.
bool pin_to(int core) {
  if (core < 0) return false;
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(core), &set);
  return sched_setaffinity(0, sizeof set, &set) == 0;
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

/// Signals of users and schedulers end the sweep, which then ends its workers.
void leave_signals_to_sweep() {
  struct sigaction action {};
  action.sa_handler = [](int) {};
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
}

/// Temporary files of programs. Programs end before their files are removed.
struct Programs {
  ScratchFolder scratch;
  int socket;  ///< to the sweep
  explicit Programs(int to_sweep) : socket(to_sweep) {}
  ~Programs() {
    end_servers();
    if (has_sweep_ended(socket)) scratch.remove_with_parent();
  }
  Programs(const Programs&) = delete;
  Programs& operator=(const Programs&) = delete;
};

std::size_t memory_of(const Sequence& s) {
  return sizeof(StampedPose) *
             (s.reference.size() + s.problem.keyframes.size() + s.problem.frames.size()) +
         sizeof(Edge) * (s.problem.odometry.size() + s.problem.closures.size());
}

/// The sequence and its metadata, or the reason why there is none.
std::string packed_sequence(const WorkerContext& context, const Cell& cell) {
  Failure failure{Failure::Kind::loading, Status::failed, "", ""};
  std::string sequence_bytes;
  catch_errors(failure, [&] {
    try {
      const Sequence sequence = load_sequence(cell, context.sweep, context.catalogue, context.root);
      sequence_bytes = packed(sequence, metadata_of(sequence, cell, context.sweep));
      failure.status = Status::ok;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const MissingPart& error) {
      failure = {Failure::Kind::missing_part, Status::failed, error.what(), ""};
    } catch (const std::exception& error) {
      failure = {Failure::Kind::input_error, Status::failed, error.what(), ""};
    }
  });
  return packed(failure) + sequence_bytes;
}

/// Loaded sequences, each by a process of its own, so that nothing of a dataset's code remains in
/// the worker: memory, threads, signal handlers.
class LoadedSequences {
 public:
  struct Entry {
    std::size_t dataset = 0;
    int repeat = 0;
    Sequence sequence;
    SequenceMetadata metadata;
  };
  LoadedSequences(const WorkerContext& context, WatchedProcesses& processes)
      : context_(context), processes_(processes) {}

  /// Null unless it is loaded.
  const Entry* find(const Cell& cell) {
    const auto found = std::ranges::find_if(entries_, [&](const Entry& entry) {
      return entry.dataset == cell.dataset && entry.repeat == cell.repeat;
    });
    if (found == entries_.end()) return nullptr;
    entries_.splice(entries_.begin(), entries_, found);
    return &entries_.front();
  }

  /// Loads it; evicts the least recently used sequences beyond kMostBytes. Null if that fails, with
  /// the reason in `failure`. Throws std::runtime_error if no process can be created.
  const Entry* load(const Cell& cell, Failure& failure) {
    program_sandbox() = context_.sandbox;
    const Choice& dataset = context_.sweep.datasets[cell.dataset].dataset;
    const DatasetEntry& known = find_dataset(context_.catalogue, dataset.name);
    if (known.prepare) known.prepare(dataset.options);
    const Limits limits = loading_limits(dataset, context_.sweep.limits);
    // Others draw their progress on a terminal.
    const bool is_foreign = !plugin_version(context_.catalogue, "dataset", dataset.name).empty();
    const ProcessEnd end = processes_.run({.subject = "loading its sequence",
                                           .limits = limits,
                                           .when = ", while loading its sequence",
                                           .is_captured = is_foreign,
                                           .kept = {},
                                           .run = [&] { return packed_sequence(context_, cell); }});
    failure = {Failure::Kind::loading, end.status, end.why, end.signal};
    if (end.status != Status::ok) return nullptr;
    Unpacker unpacker(end.result);
    unpacker(failure);
    if (failure.status != Status::ok) return nullptr;
    Entry entry{cell.dataset, cell.repeat, {}, {}};
    unpacker(entry.sequence)(entry.metadata);
    return keep(std::move(entry));
  }

 private:
  /// Limit on poses and edges: every cell's process starts as a copy of all of them.
  static constexpr std::size_t kMostBytes = std::size_t{2} << 20;

  const Entry* keep(Entry added) {
    entries_.push_front(std::move(added));
    std::size_t total = 0;
    for (auto entry = entries_.begin(); entry != entries_.end();) {
      total += memory_of(entry->sequence);
      const bool keep = entry == entries_.begin() || total <= kMostBytes;
      entry = keep ? std::next(entry) : entries_.erase(entry);
    }
    return &entries_.front();
  }

  const WorkerContext& context_;
  WatchedProcesses& processes_;
  std::list<Entry> entries_;  ///< most recently used first
};

class JobRunner {
 public:
  JobRunner(const WorkerContext& context, int socket, int core, const ScratchFolder* scratch)
      : context_(context),
        socket_(socket),
        core_(core),
        processes_(socket, scratch),
        loaded_(context, processes_) {}

  /// Answers one job; false if the sweep has closed the socket. Throws std::runtime_error if no
  /// process can be created.
  bool work(const Job& job) {
    const Cell& cell = context_.cells[job.cell];
    const LoadedSequences::Entry* entry = loaded_.find(cell);
    if (entry == nullptr) {
      Failure failure;
      entry = loaded_.load(cell, failure);
      if (entry == nullptr) return answer(failure);
      if (!answer(Header::Kind::loaded, packed(entry->metadata))) return false;
    }
    if (job.only_load) return answer(Header::Kind::only_loaded, "");
    const ProcessEnd end = run(cell, *entry);
    if (end.status == Status::ok) return answer(Header::Kind::result, end.result);
    return answer({Failure::Kind::cell, end.status, end.why, end.signal});
  }

  bool answer(const Failure& failure) const {
    return answer(Header::Kind::failure, packed(failure));
  }

 private:
  bool answer(Header::Kind kind, std::string_view bytes) const {
    const Header header{kind, bytes.size()};
    return send_all(socket_, &header, sizeof header) &&
           send_all(socket_, bytes.data(), bytes.size());
  }

  /// Runs a cell in a process of its own; its result is a packed CellResult without metadata.
  ProcessEnd run(const Cell& cell, const LoadedSequences::Entry& entry) {
    const Sweep& sweep = context_.sweep;
    if (uses_programs(sweep)) hide_inputs(entry.metadata.inputs);
    prepare_programs(sweep.methods[cell.method], sweep);
    const auto run_here = [&] {
      const bool is_pinned = pin_to(core_);
      CellResult result = run_cell(cell, sweep, entry.sequence, context_.catalogue);
      result.worker = {true, context_.is_alone, is_pinned, result.worker.stated};
      apply_memory_limit(sweep.limits, result);
      return packed(result);
    };
    return processes_.run({.subject = "the cell",
                           .limits = sweep.limits,
                           .when = "",
                           .is_captured = true,
                           .kept = running_servers().descriptors,
                           .run = run_here});
  }

  /// Hides the files of the sequence from programs of its cells.
  void hide_inputs(const std::vector<InputFile>& inputs) {
    if (!std::ranges::equal(inputs, hidden_, {}, &InputFile::path, &InputFile::path)) {
      hidden_ = inputs;
      end_servers();  // they are in the previous sandbox
    }
    program_sandbox() = context_.sandbox;
    for (const InputFile& input : inputs) program_sandbox().hidden.emplace_back(input.path);
  }

  const WorkerContext& context_;
  int socket_;
  int core_;
  WatchedProcesses processes_;
  LoadedSequences loaded_;
  std::vector<InputFile> hidden_;  ///< inputs that running servers cannot read
};

}  // namespace

void run_worker(const WorkerContext& context, int socket, int core) {
  leave_signals_to_sweep();
  // Large blocks have mappings of their own, which leave no holes in the heap when they are freed:
  // cells would take their memory from these, page by page.
  mallopt(M_MMAP_THRESHOLD, 64 << 10);
  hardware_threads();  // asks the system once for all cells
  std::optional<Programs> programs;
  if (uses_programs(context.sweep)) programs.emplace(socket);
  JobRunner runner(context, socket, core, programs ? &programs->scratch : nullptr);
  for (Job job; receive_job(socket, job);) {
    try {
      if (!runner.work(job)) return;
    } catch (const std::exception& error) {
      runner.answer({Failure::Kind::system, Status::failed, error.what(), ""});
      return;
    }
  }
}

}  // namespace loopbench::harness
