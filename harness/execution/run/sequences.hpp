/// The sequences of a sweep, each loaded once and let go when its last cell is done.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "datasets/core/sequence.hpp"
#include "harness/catalogue/catalogue.hpp"
#include "harness/model/cells.hpp"
#include "harness/model/sequence_facts.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench {

/// What is kept about the sequence of a cell; its dataset's `group` goes before the source. Throws
/// InputError.
SequenceFacts facts_of(const Sequence& sequence, const Cell& cell, const Sweep& sweep);

/// Thread-safe.
class Sequences {
 public:
  Sequences(const Sweep& sweep,
            const Catalogue& catalogue,
            DataRoot root,
            const std::vector<Cell>& cells);

  /// The sequence of a cell, loaded by whoever asks first. Throws InputError with the dataset's
  /// label when a file is missing or broken.
  std::shared_ptr<const Sequence> get(const Cell& cell);

  /// What is kept about it. Only after get().
  std::shared_ptr<const SequenceFacts> facts(const Cell& cell);

  /// Says that a cell will not ask again.
  void done(const Cell& cell);

 private:
  struct Slot {
    std::mutex mutex;
    std::shared_ptr<const Sequence> sequence;
    std::shared_ptr<const SequenceFacts> facts;
    std::size_t waiting = 0;  ///< cells not done yet
  };
  using Key = std::pair<std::size_t, int>;  // dataset, repeat

  const Sweep& sweep_;
  const Catalogue& catalogue_;
  DataRoot root_;
  std::map<Key, Slot> slots_;  ///< complete after construction: only the slots' insides change
};

}  // namespace loopbench
