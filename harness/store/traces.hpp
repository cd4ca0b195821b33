/// Reads the data for plots from a store.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "harness/model/trace.hpp"
#include "harness/store/cell_rows.hpp"
#include "harness/store/sqlite.hpp"
#include "methods/report.hpp"

namespace loopbench::harness {

/// Traces of one store, which stays open; not thread-safe.
class Traces {
 public:
  /// `file` can be the folder with results.sqlite. Throws InputError if cells, sections or
  /// sequences are damaged. O(rows of these).
  explicit Traces(const std::filesystem::path& file);

  /// Trace of the cell at that position of the sweep (Record::cell); nullopt if none is stored.
  /// Throws InputError if it is damaged, as does sequence().
  std::optional<CellTrace> cell(std::int64_t position);

  /// Sections of the path as reported by the method; empty without a report. Stamps [s].
  std::vector<methods::Section> sections(std::int64_t position);

  /// Trace of the sequence of the cell at that position; nullopt if none is stored.
  std::optional<SequenceTrace> sequence(std::int64_t position);

 private:
  const StoredCell* row(std::int64_t position) const;

  Database database_;
  std::vector<StoredCell> cells_;
  std::vector<std::vector<methods::Section>> sections_;  ///< parallel to cells_
  std::unordered_map<std::int64_t, std::size_t> by_position_;
};

/// Raw memory of a list of trace structs; valid as long as the list.
template <class Item>
std::string_view bytes_of(const std::vector<Item>& items) {
  return {reinterpret_cast<const char*>(items.data()), items.size() * sizeof(Item)};
}

}  // namespace loopbench::harness
