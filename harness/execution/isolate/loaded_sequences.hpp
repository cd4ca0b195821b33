/// Cache of a worker's loaded sequences.
#pragma once

#include <list>
#include <memory>

#include "harness/execution/isolate/worker.hpp"
#include "harness/model/sequence_metadata.hpp"

namespace loopbench::harness {

class LoadedSequences {
 public:
  struct Entry {
    std::size_t dataset = 0;
    int repeat = 0;
    Sequence sequence;
    SequenceMetadata metadata;
  };

  explicit LoadedSequences(const WorkerContext& context) : context_(context) {}

  /// Null unless it is loaded.
  const Entry* find(const Cell& cell);

  /// Loads it; evicts the least recently used sequences beyond kMostBytes. Throws InputError.
  const Entry& load(const Cell& cell);

 private:
  /// Limit on poses and edges: every cell's process starts as a copy of all of them.
  static constexpr std::size_t kMostBytes = std::size_t{16} << 20;

  const WorkerContext& context_;
  std::list<Entry> entries_;  ///< most recently used first
};

}  // namespace loopbench::harness
