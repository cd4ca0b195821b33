/// Metadata of the sequences whose cells are not finished.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "datasets/core/error.hpp"
#include "harness/catalogue/loading.hpp"
#include "harness/model/sequence_metadata.hpp"

namespace loopbench::harness {

/// By group of cells: every worker loads its own copy of a sequence, but one metadata is kept, and
/// its notes are printed once.
class KeptMetadata {
 public:
  explicit KeptMetadata(std::size_t groups) : metadata_(groups) {}

  /// `label`: of the dataset. Throws InputError if another worker read other files.
  void keep(std::size_t group,
            const std::string& label,
            std::shared_ptr<const SequenceMetadata> metadata) {
    std::shared_ptr<const SequenceMetadata>& kept = metadata_[group];
    if (kept && !std::ranges::equal(
                    kept->inputs, metadata->inputs, {}, &InputFile::hash, &InputFile::hash)) {
      throw InputError(metadata->inputs.front().path +
                       " or a file read with it changed during the run");
    }
    if (kept) return;
    print_notes(label, metadata->notes);
    kept = std::move(metadata);
  }

  /// Null if the sequence is not loaded.
  const std::shared_ptr<const SequenceMetadata>& of(std::size_t group) const {
    return metadata_[group];
  }

  void drop(std::size_t group) { metadata_[group].reset(); }

 private:
  std::vector<std::shared_ptr<const SequenceMetadata>> metadata_;
};

}  // namespace loopbench::harness
