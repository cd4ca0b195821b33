/// Loads each sequence of a sweep once and frees it after its last cell.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "datasets/core/sequence.hpp"
#include "harness/catalogue/catalogue.hpp"
#include "harness/model/cells.hpp"
#include "harness/model/sequence_metadata.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Metadata of the sequence of a cell; the dataset's `group` overrides the source. Throws
/// InputError.
SequenceMetadata metadata_of(const Sequence& sequence, const Cell& cell, const Sweep& sweep);

/// Thread-safe.
class Sequences {
 public:
  Sequences(const Sweep& sweep,
            const Catalogue& catalogue,
            DataRoot root,
            const std::vector<Cell>& cells);

  /// The sequence of a cell, loaded by the first caller. Throws InputError with the dataset's label
  /// if a file is missing or invalid.
  std::shared_ptr<const Sequence> get(const Cell& cell);

  /// Metadata of the sequence. Only after get().
  std::shared_ptr<const SequenceMetadata> metadata(const Cell& cell);

  /// Declares that a cell does not need its sequence any more.
  void done(const Cell& cell);

 private:
  struct Slot {
    std::mutex mutex;
    std::shared_ptr<const Sequence> sequence;
    std::shared_ptr<const SequenceMetadata> metadata;
    std::size_t waiting = 0;  ///< unfinished cells
  };
  using Key = std::pair<std::size_t, int>;  // dataset, repeat

  const Sweep& sweep_;
  const Catalogue& catalogue_;
  DataRoot root_;
  std::map<Key, Slot> slots_;  ///< keys are fixed after construction; only slots change
};

}  // namespace loopbench::harness
