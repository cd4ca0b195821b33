/// Reading back what a report draws.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "harness/run/trace.hpp"
#include "harness/store/sqlite.hpp"
#include "methods/report.hpp"

namespace loopbench {

/// The traces of one store, which stays open; not for several threads at once.
class Traces {
 public:
  /// `file` may be the folder that holds results.sqlite. Throws InputError.
  explicit Traces(const std::filesystem::path& file);

  /// Of the cell at that position of the sweep (Record::cell); nothing when none was kept.
  std::optional<CellTrace> cell(std::int64_t position);

  /// How the method of that cell cut up the way; empty when it told nothing. Stamps [s].
  std::vector<Section> sections(std::int64_t position);

  /// Of the sequence of the cell at that position; nothing when none was kept.
  std::optional<SequenceTrace> sequence(std::int64_t position);

 private:
  Database database_;
};

/// A list of trace structs as they lie in memory; valid as long as the list.
template <class Item>
std::string_view bytes_of(const std::vector<Item>& items) {
  return {reinterpret_cast<const char*>(items.data()), items.size() * sizeof(Item)};
}

}  // namespace loopbench
