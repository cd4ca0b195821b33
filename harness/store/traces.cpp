#include "harness/store/traces.hpp"

#include <bit>
#include <cstring>

#include "datasets/core/error.hpp"
#include "harness/store/open.hpp"

namespace loopbench {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class Item>
std::vector<Item> from_blob(const std::string& bytes) {
  if (bytes.size() % sizeof(Item) != 0) throw InputError("a trace in the store is cut off");
  std::vector<Item> out(bytes.size() / sizeof(Item));
  if (!out.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
  return out;
}

}  // namespace

Traces::Traces(const std::filesystem::path& file) : database_(open_store(file)) {}

std::optional<CellTrace> Traces::cell(std::int64_t position) {
  Statement row = database_.prepare(
      "SELECT t.times, t.samples FROM trace t JOIN cell c ON c.id = t.cell WHERE c.position = ?");
  if (!row.bind(position).step()) return std::nullopt;
  CellTrace out;
  out.times = from_text<Times>(row.text()).value_or(Times::dense);
  out.samples = from_blob<TraceSample>(row.blob());
  return out;
}

std::vector<Section> Traces::sections(std::int64_t position) {
  Statement rows = database_.prepare(
      "SELECT s.kind, s.begin_stamp, s.end_stamp, s.what FROM section s JOIN cell c ON c.id = "
      "s.cell "
      "WHERE c.position = ? ORDER BY s.rowid");
  rows.bind(position);
  std::vector<Section> out;
  while (rows.step()) {
    Section& section = out.emplace_back();
    section.kind = rows.text();
    section.begin = rows.real();
    section.end = rows.real();
    section.what = rows.text();
  }
  return out;
}

std::optional<SequenceTrace> Traces::sequence(std::int64_t position) {
  Statement row = database_.prepare(
      "SELECT s.origin_stamp, s.origin_x, s.origin_y, s.origin_z, s.reference, s.keyframes, "
      "s.closures FROM sequence_trace s JOIN cell c ON c.asked = s.asked WHERE c.position = ?");
  if (!row.bind(position).step()) return std::nullopt;
  SequenceTrace out;
  for (double* number : {&out.origin.stamp, &out.origin.x, &out.origin.y, &out.origin.z}) {
    *number = row.real();
  }
  out.reference = from_blob<TracePose>(row.blob());
  out.keyframes = from_blob<TracePose>(row.blob());
  out.closures = from_blob<TraceClosure>(row.blob());
  return out;
}

}  // namespace loopbench
