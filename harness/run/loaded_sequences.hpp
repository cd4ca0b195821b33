/// A worker's loaded sequences.
#pragma once

#include <list>

#include "datasets/core/sequence.hpp"
#include "harness/model/sequence_metadata.hpp"
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

}  // namespace loopbench::harness
