/// Reading back what a report draws.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "harness/model/trace.hpp"
#include "harness/store/cell_rows.hpp"
#include "harness/store/sequence_rows.hpp"
#include "harness/store/sqlite.hpp"
#include "methods/report.hpp"

namespace loopbench {

/// The traces of one store, which stays open; not for several threads at once.
class Traces {
 public:
  /// `file` may be the folder that holds results.sqlite. Throws InputError when
  /// its cells, sections or sequences are not what was written. O(rows of these).
  explicit Traces(const std::filesystem::path& file);

  /// Of the cell at that position of the sweep (Record::cell); nothing when none was kept. Throws
  /// InputError when it is not what was written, as sequence() does.
  std::optional<CellTrace> cell(std::int64_t position);

  /// How the method of that cell cut up the way; empty when it told nothing. Stamps [s].
  std::vector<Section> sections(std::int64_t position);

  /// Of the sequence of the cell at that position; nothing when none was kept.
  std::optional<SequenceTrace> sequence(std::int64_t position);

 private:
  const CellRow* row(std::int64_t position) const;

  std::filesystem::path file_;
  Database database_;
  CellRows rows_;
  SequenceRows sequences_;
  std::vector<std::vector<Section>> sections_;  ///< as rows_
  std::unordered_map<std::int64_t, std::size_t> by_position_;
};

/// A list of trace structs as they lie in memory; valid as long as the list.
template <class Item>
std::string_view bytes_of(const std::vector<Item>& items) {
  return {reinterpret_cast<const char*>(items.data()), items.size() * sizeof(Item)};
}

}  // namespace loopbench
