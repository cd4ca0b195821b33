#include "harness/store/traces.hpp"

#include <bit>
#include <cstring>

#include "datasets/core/error.hpp"
#include "harness/store/open.hpp"
#include "harness/store/schema.hpp"
#include "harness/store/stored_cells.hpp"

namespace loopbench::harness {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class Item>
std::vector<Item> from_blob(std::string_view bytes) {
  if (bytes.size() % sizeof(Item) != 0) throw InputError("a trace in the store is truncated");
  std::vector<Item> out(bytes.size() / sizeof(Item));
  if (!out.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
  return out;
}

std::string query(const CellTable& table) {
  return std::string("SELECT ") + table.columns + ", checksum FROM " + table.name +
         " WHERE cell = (SELECT id FROM cell WHERE position = ?)";  // in the order of the key
}

}  // namespace

Traces::Traces(const std::filesystem::path& file) : database_(open_store(file)) {
  database_.execute("COMMIT");  // a report takes long and must not block writers
}

void Traces::require_intact(const Statement& row, const char* what) const {
  if (!row.is_intact(0)) throw_damaged(database_.file(), what);
}

std::optional<CellTrace> Traces::cell(std::int64_t position) {
  Statement row = database_.prepare(query(kTraceTable));
  if (!row.bind(position).step()) return std::nullopt;
  require_intact(row, "the trace of a cell is");
  CellTrace out;
  out.times = from_text<metrics::Times>(row.text()).value_or(metrics::Times::dense);
  out.samples = from_blob<TraceSample>(row.view());
  out.causal = from_blob<TraceSample>(row.view());
  Statement each = database_.prepare(query(kSnapshotTable));
  each.bind(position);
  while (each.step()) {
    require_intact(each, "a snapshot is");
    each.integer();  // number
    TraceSnapshot& snapshot = out.snapshots.emplace_back();
    each.read(snapshot.time);
    snapshot.poses = from_blob<TracePose>(each.view());
  }
  return out;
}

std::vector<methods::Section> Traces::sections(std::int64_t position) {
  std::vector<methods::Section> out;
  Statement row = database_.prepare(query(kSectionTable));
  row.bind(position);
  while (row.step()) {
    require_intact(row, "a section is");
    row.integer();  // number
    methods::Section& section = out.emplace_back();
    row.read(section.kind, section.begin, section.end, section.what);
  }
  return out;
}

std::optional<SequenceTrace> Traces::sequence(std::int64_t position) {
  Statement row = database_.prepare(
      std::string("SELECT ") + kSequenceTraceColumns +
      ", checksum FROM sequence_trace WHERE sequence_key = (SELECT sequence_key FROM cell WHERE "
      "position = ?)");
  if (!row.bind(position).step()) return std::nullopt;
  require_intact(row, "the trace of a sequence is");
  row.view();  // sequence_key
  SequenceTrace out;
  row.read(out.origin.stamp, out.origin.x, out.origin.y, out.origin.z);
  out.reference = from_blob<TracePose>(row.view());
  out.keyframes = from_blob<TracePose>(row.view());
  out.closures = from_blob<TraceClosure>(row.view());
  return out;
}

}  // namespace loopbench::harness
