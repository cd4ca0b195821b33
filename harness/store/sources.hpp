/// What the cells of the current config were computed from.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/model/sequence_metadata.hpp"
#include "harness/store/sequence_rows.hpp"
#include "harness/store/sqlite.hpp"
#include "harness/text/shared_text.hpp"

namespace loopbench::harness {

/// One state of a store. The cells are not checked: whoever reads their numbers does that. Other
/// damage is an InputError.
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
  const SequenceRows& rows();

  std::filesystem::path file_;
  Database database_;
  // By the position of the first cell that uses them.
  std::map<std::int64_t, SharedText> made_;  ///< keys of table provenance
  std::map<std::int64_t, std::pair<std::string, SharedText>> sequences_;  ///< label and key
  std::optional<SequenceRows> rows_;
};

}  // namespace loopbench::harness
