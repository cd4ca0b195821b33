/// Reads the data for plots from a store.
#pragma once

#include <bit>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/core/error.hpp"
#include "harness/sweep/model/packed_columns.hpp"
#include "harness/sweep/model/trace.hpp"
#include "harness/sweep/store/open.hpp"
#include "harness/sweep/store/stored_cells.hpp"
#include "methods/report.hpp"

namespace loopbench::harness {

/// Traces of one store, which stays open; not thread-safe. Cells are given by their position in the
/// sweep (CellRow::position). Throws InputError if a trace is damaged; read_cells() checks
/// sections.
class Traces {
 public:
  /// `file` can be the folder with results.sqlite.
  explicit Traces(const std::filesystem::path& file);

  /// Trace of a cell; nullopt if none is stored.
  std::optional<CellTrace> cell(std::int64_t position);

  /// Bytes of the packed poses and values of each cell with a trace, by position.
  std::map<std::int64_t, std::size_t> sizes();

  /// Sections of the path as reported by the method; empty without a report. Stamps [s].
  std::vector<methods::Section> sections(std::int64_t position);

  /// Trace of the sequence of a cell; nullopt if none is stored.
  std::optional<SequenceTrace> sequence(std::int64_t position);

 private:
  Database database_;
};

/// Items of floats as columns; see harness/sweep/model/packed_columns.hpp.
template <class Item>
std::string packed_items(const std::vector<Item>& items, unsigned steps) {
  constexpr std::size_t kColumns = sizeof(Item) / sizeof(float);
  std::vector<float> rows(items.size() * kColumns);
  if (!rows.empty()) std::memcpy(rows.data(), items.data(), rows.size() * sizeof(float));
  return packed_columns(rows, kColumns, steps);
}

/// The items that packed_items() packed. Throws InputError if the bytes are damaged.
template <class Item>
std::vector<Item> unpacked_items(std::string_view bytes, unsigned steps) {
  const std::vector<float> rows = unpacked_columns(bytes, sizeof(Item) / sizeof(float), steps);
  std::vector<Item> out(rows.size() * sizeof(float) / sizeof(Item));
  static_assert(std::is_trivially_copyable_v<Item>);
  void* const bytes_of_items = out.data();
  if (!out.empty()) std::memcpy(bytes_of_items, rows.data(), rows.size() * sizeof(float));
  return out;
}

static_assert(std::endian::native == std::endian::little);

/// Raw memory of a list of trace structs; valid as long as the list.
template <class Item>
std::string_view bytes_of(const std::vector<Item>& items) {
  return {reinterpret_cast<const char*>(items.data()), items.size() * sizeof(Item)};
}

template <class Item>
std::vector<Item> from_blob(std::string_view bytes) {
  if (bytes.size() % sizeof(Item) != 0) throw InputError("a trace in the store is truncated");
  std::vector<Item> out(bytes.size() / sizeof(Item));
  if (!out.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
  return out;
}

/// Selects the rows of a cell from a table, in the order of its key.
inline std::string rows_of_cell(const std::string& table) {
  return "SELECT * FROM " + table + " WHERE cell = (SELECT id FROM cell WHERE position = ?)";
}

inline Traces::Traces(const std::filesystem::path& file) : database_(open_store(file)) {
  database_.execute("COMMIT");  // a report takes long and must not block writers
}

inline std::optional<CellTrace> Traces::cell(std::int64_t position) {
  Statement stored = database_.prepare(
      "SELECT id, trace_hash, sequence, repeat, method FROM cell WHERE position = ?");
  // While this is at a row, the queries that follow see the same state.
  if (!stored.bind(position).step()) return std::nullopt;
  StoredCell named;
  stored.read(named.id, named.trace_hash, named.sequence, named.repeat, named.method);
  if (trace_hash(database_, named.id) != named.trace_hash) {
    throw_damaged(database_.file(), "the trace of " + label_of(named) + " is");
  }
  Statement row = database_.prepare(rows_of_cell("trace"));
  if (!row.bind(position).step()) return std::nullopt;
  CellTrace out;
  row.integer();  // cell
  out.times = from_text<metrics::Times>(row.text()).value_or(metrics::Times::dense);
  out.samples = unpacked_items<TraceSample>(row.view(), kDrawnSteps);
  Statement values = database_.prepare(rows_of_cell("pose_value"));
  values.bind(position);
  std::int64_t cell = 0, number = 0;
  while (values.step()) {
    TraceValues& added = out.values.emplace_back();
    values.read(cell, number, added.name, added.unit);
    added.values = unpacked_items<float>(values.view(), kDrawnSteps);
  }
  return out;
}

inline std::map<std::int64_t, std::size_t> Traces::sizes() {
  std::map<std::int64_t, std::size_t> out;
  Statement row = database_.prepare(
      "SELECT position, sum(size) FROM (SELECT cell, length(samples) AS size FROM trace UNION ALL "
      "SELECT cell, length(value) FROM pose_value) JOIN cell ON cell.id = cell WHERE position IS "
      "NOT NULL GROUP BY position");
  while (row.step()) {
    const std::int64_t position = row.integer();
    out.emplace(position, row.integer());
  }
  return out;
}

inline std::vector<methods::Section> Traces::sections(std::int64_t position) {
  std::vector<methods::Section> out;
  Statement row = database_.prepare(rows_of_cell("section"));
  row.bind(position);
  std::int64_t cell = 0, number = 0;
  while (row.step()) {
    methods::Section& section = out.emplace_back();
    row.read(cell, number, section.kind, section.begin, section.end, section.what);
  }
  return out;
}

inline std::optional<SequenceTrace> Traces::sequence(std::int64_t position) {
  Statement row = database_.prepare(
      "SELECT row_hash, * FROM sequence_trace WHERE sequence_key = (SELECT sequence_key FROM cell "
      "WHERE position = ?)");
  if (!row.bind(position).step()) return std::nullopt;
  std::uint64_t hash = 0;
  row.read(hash);
  const std::string key = row.text();
  if (row.hashed(0, 1, 1) != hash) {
    throw_damaged(database_.file(), "row " + key + " of its table sequence_trace is");
  }
  SequenceTrace out;
  row.read(out.origin.stamp, out.origin.x, out.origin.y, out.origin.z);
  out.reference = unpacked_items<TracePose>(row.view(), kFineSteps);
  out.keyframes = unpacked_items<TracePose>(row.view(), kFineSteps);
  out.closures = from_blob<TraceClosure>(row.view());
  out.ledger = row.text();
  return out;
}

}  // namespace loopbench::harness
