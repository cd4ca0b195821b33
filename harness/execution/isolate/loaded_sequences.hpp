/// The sequences a worker has at hand, so that cells of one do not load it again.
#pragma once

#include <list>
#include <memory>

#include "harness/execution/isolate/worker.hpp"
#include "harness/model/sequence_facts.hpp"

namespace loopbench {

class LoadedSequences {
 public:
  struct Entry {
    std::size_t dataset = 0;
    int repeat = 0;
    Sequence sequence;
    SequenceFacts facts;
  };

  explicit LoadedSequences(const WorkerContext& context) : context_(context) {}

  /// Null unless it is at hand.
  const Entry* find(const Cell& cell);

  /// Loads it; lets go of those used longest ago beyond kMostBytes. Throws InputError.
  const Entry& load(const Cell& cell);

 private:
  /// Of poses and edges. Repeats follow each other and are not asked for again: memory they give
  /// back is warm, more of it would have to be fetched from the system page by page.
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20;

  const WorkerContext& context_;
  std::list<Entry> entries_;  ///< last used first
};

}  // namespace loopbench
