#include "harness/execution/isolate/loaded_sequences.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "datasets/core/error.hpp"
#include "harness/catalogue/load_sequence.hpp"
#include "harness/execution/isolate/cell_child.hpp"
#include "harness/execution/isolate/pack_result.hpp"
#include "harness/execution/isolate/pack_sequence.hpp"
#include "harness/execution/isolate/warm_heap.hpp"
#include "harness/execution/run/catch_errors.hpp"
#include "harness/execution/run/describe_sequence.hpp"

namespace loopbench::harness {
namespace {

std::size_t bytes_of(const Sequence& s) {
  return sizeof(StampedPose) *
             (s.reference.size() + s.problem.keyframes.size() + s.problem.frames.size()) +
         sizeof(Edge) * (s.problem.odometry.size() + s.problem.closures.size());
}

/// In the forked process: leaves the sequence and its metadata, or the reason why there is none.
[[noreturn]] void load_and_exit(const WorkerContext& context,
                                const Cell& cell,
                                pid_t worker,
                                ResultArea& area) {
  detach_from_worker(worker, context.sweep.limits.memory);
  warm_heap();
  dup2(STDERR_FILENO, STDOUT_FILENO);  // the standard output is the sweep's
  connect_streams(STDIN_FILENO, STDERR_FILENO, {});
  LoadedSequences::Failure failure;
  Packer pack;
  catch_errors(failure, [&] {
    try {
      const Sequence sequence = load_sequence(cell, context.sweep, context.catalogue, context.root);
      const SequenceMetadata metadata = metadata_of(sequence, cell, context.sweep);
      pack(failure.kind)(Status::ok)(std::string())(sequence)(metadata);
      failure.status = Status::ok;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const MissingPart& error) {
      failure = {LoadedSequences::Failure::Kind::missing_part, Status::failed, error.what(), ""};
    } catch (const std::exception& error) {
      failure = {LoadedSequences::Failure::Kind::input_error, Status::failed, error.what(), ""};
    }
  });
  if (failure.status != Status::ok) pack(failure.kind)(failure.status)(failure.why);
  const bool is_written = area.write(pack.bytes());
  std::fflush(stdout);
  _exit(is_written ? 0 : 1);  // without running the sweep's destructors
}

}  // namespace

const LoadedSequences::Entry* LoadedSequences::find(const Cell& cell) {
  const auto found = std::ranges::find_if(entries_, [&](const Entry& entry) {
    return entry.dataset == cell.dataset && entry.repeat == cell.repeat;
  });
  if (found == entries_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found);
  return &entries_.front();
}

std::variant<const LoadedSequences::Entry*, LoadedSequences::Failure> LoadedSequences::load(
    const Cell& cell) {
  program_sandbox() = context_.sandbox;
  const Choice& dataset = context_.sweep.datasets[cell.dataset].dataset;
  const DatasetEntry& known = find_dataset(context_.catalogue, dataset.name);
  if (known.prepare) known.prepare(dataset.options);
  const pid_t worker = getpid();
  const ProcessEnd end = processes_.run(
      "loading its sequence", ", while loading its sequence", [&](ResultArea& area, int) {
        load_and_exit(context_, cell, worker, area);
      });
  if (end.status != Status::ok)
    return Failure{Failure::Kind::ended, end.status, end.why, end.signal};
  Unpacker unpack(end.result);
  Failure failure;
  unpack(failure.kind)(failure.status)(failure.why);
  if (failure.status != Status::ok) return failure;
  Entry entry{cell.dataset, cell.repeat, {}, {}};
  unpack(entry.sequence)(entry.metadata);
  return keep(std::move(entry));
}

const LoadedSequences::Entry* LoadedSequences::keep(Entry added) {
  entries_.push_front(std::move(added));
  std::size_t total = 0;
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    total += bytes_of(entry->sequence);
    const bool keep = entry == entries_.begin() || total <= kMostBytes;
    entry = keep ? std::next(entry) : entries_.erase(entry);
  }
  return &entries_.front();
}

}  // namespace loopbench::harness
