/// A worker's loaded sequences.
#pragma once

#include <algorithm>
#include <list>

#include "datasets/core/error.hpp"
#include "datasets/core/sequence.hpp"
#include "harness/catalogue/command_dataset.hpp"
#include "harness/catalogue/load_sequence.hpp"
#include "harness/model/sequence_metadata.hpp"
#include "harness/run/catch_errors.hpp"
#include "harness/run/pack.hpp"
#include "harness/run/summarise_sequence.hpp"
#include "harness/run/watched_process.hpp"
#include "harness/run/worker.hpp"

namespace loopbench::harness {

/// Each is loaded by a process of its own, so that nothing of a dataset's code remains in the
/// worker: memory, threads, signal handlers.
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
  const Entry* find(const Cell& cell);

  /// Loads it; evicts the least recently used sequences beyond kMostBytes. Null if that fails, with
  /// the reason in `failure`. Throws std::runtime_error if no process can be created.
  const Entry* load(const Cell& cell, Failure& failure);

 private:
  /// Limit on poses and edges: every cell's process starts as a copy of all of them.
  static constexpr std::size_t kMostBytes = std::size_t{2} << 20;

  const Entry* keep(Entry entry);

  const WorkerContext& context_;
  WatchedProcesses& processes_;
  std::list<Entry> entries_;  ///< most recently used first
};

inline std::size_t memory_of(const Sequence& s) {
  return sizeof(StampedPose) *
             (s.reference.size() + s.problem.keyframes.size() + s.problem.frames.size()) +
         sizeof(Edge) * (s.problem.odometry.size() + s.problem.closures.size());
}

/// The sequence and its metadata, or the reason why there is none.
inline std::string packed_sequence(const WorkerContext& context, const Cell& cell) {
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

inline const LoadedSequences::Entry* LoadedSequences::find(const Cell& cell) {
  const auto found = std::ranges::find_if(entries_, [&](const Entry& entry) {
    return entry.dataset == cell.dataset && entry.repeat == cell.repeat;
  });
  if (found == entries_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found);
  return &entries_.front();
}

inline const LoadedSequences::Entry* LoadedSequences::load(const Cell& cell, Failure& failure) {
  program_sandbox() = context_.sandbox;
  const Choice& dataset = context_.sweep.datasets[cell.dataset].dataset;
  const DatasetEntry& known = find_dataset(context_.catalogue, dataset.name);
  if (known.prepare) known.prepare(dataset.options);
  const Limits limits = loading_limits(dataset, context_.sweep.limits);
  const ProcessEnd end = processes_.run({.subject = "loading its sequence",
                                         .limits = limits,
                                         .when = ", while loading its sequence",
                                         .is_captured = false,
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

inline const LoadedSequences::Entry* LoadedSequences::keep(Entry added) {
  entries_.push_front(std::move(added));
  std::size_t total = 0;
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    total += memory_of(entry->sequence);
    const bool keep = entry == entries_.begin() || total <= kMostBytes;
    entry = keep ? std::next(entry) : entries_.erase(entry);
  }
  return &entries_.front();
}

}  // namespace loopbench::harness
