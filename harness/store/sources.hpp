/// What the cells of the current config were computed from.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/model/sequence_metadata.hpp"
#include "harness/store/sequence_rows.hpp"
#include "harness/store/sqlite.hpp"

namespace loopbench::harness {

/// One state of a store. The cells are not checked: whoever reads their numbers does that.
class StoreSources {
 public:
  /// `file` can be the folder with results.sqlite. Throws InputError if it is not a store.
  /// O(cells).
  explicit StoreSources(const std::filesystem::path& file);

  /// Commit, compiler, machine and so on. Values that differ between cells are separate lines, in
  /// sweep order.
  std::map<std::string, std::string> provenance();

  /// Input files of each sequence, by "LABEL" or "LABEL (repeat N)".
  std::map<std::string, std::vector<InputFile>> inputs();

  /// "DATASET: all options including defaults" of each loaded sequence, by the same labels.
  std::map<std::string, std::string> dataset_options();

 private:
  /// Visits the sequences of all runs in sweep order, with their labels.
  template <class Visit>
  void for_each_sequence(Visit visit);

  Database database_;
  SequenceRows rows_;
};

}  // namespace loopbench::harness
