/// Reads the data for plots from a store.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "harness/model/trace.hpp"
#include "harness/store/sqlite.hpp"
#include "methods/report.hpp"

namespace loopbench::harness {

/// Traces of one store, which stays open; not thread-safe. Cells are given by their position in the
/// sweep (Record::cell). Throws InputError if what is read is damaged.
class Traces {
 public:
  /// `file` can be the folder with results.sqlite.
  explicit Traces(const std::filesystem::path& file);

  /// Trace of a cell; nullopt if none is stored.
  std::optional<CellTrace> cell(std::int64_t position);

  /// Sections of the path as reported by the method; empty without a report. Stamps [s].
  std::vector<methods::Section> sections(std::int64_t position);

  /// Trace of the sequence of a cell; nullopt if none is stored.
  std::optional<SequenceTrace> sequence(std::int64_t position);

 private:
  void require_intact(const Statement& row, const char* what) const;

  Database database_;
};

/// Raw memory of a list of trace structs; valid as long as the list.
template <class Item>
std::string_view bytes_of(const std::vector<Item>& items) {
  return {reinterpret_cast<const char*>(items.data()), items.size() * sizeof(Item)};
}

}  // namespace loopbench::harness
