#include "harness/store/traces.hpp"

#include <bit>
#include <cstring>

#include "datasets/core/error.hpp"
#include "harness/store/digest.hpp"
#include "harness/store/open.hpp"

namespace loopbench::harness {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class Item>
std::vector<Item> from_blob(const std::string& bytes) {
  if (bytes.size() % sizeof(Item) != 0) throw InputError("a trace in the store is truncated");
  std::vector<Item> out(bytes.size() / sizeof(Item));
  if (!out.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
  return out;
}

}  // namespace

Traces::Traces(const std::filesystem::path& file)
    : file_(store_file(file)),
      database_(open_store(file)),
      rows_(read_cell_rows(database_)),
      sequences_(read_sequence_rows(database_)),
      sections_(rows_.cells.size()) {
  read_details(database_, "section", rows_, [&](std::size_t cell, Statement& row) {
    methods::Section& section = sections_[cell].emplace_back();
    section.kind = row.text();
    section.begin = row.real();
    section.end = row.real();
    section.what = row.text();
  });
  require_intact(rows_, file_);
  require_intact(sequences_, file_);
  database_.execute("COMMIT");  // a report takes long and must not block writers
  for (const std::size_t i : in_order(rows_)) by_position_.emplace(rows_.cells[i].position, i);
}

const CellRow* Traces::row(std::int64_t position) const {
  const auto found = by_position_.find(position);
  return found == by_position_.end() ? nullptr : &rows_.cells[found->second];
}

std::optional<CellTrace> Traces::cell(std::int64_t position) {
  const CellRow* cell = row(position);
  if (cell == nullptr) return std::nullopt;
  if (cell->details[detail_number("trace")] == Hash{}) return std::nullopt;
  Statement found = database_.prepare("SELECT * FROM trace WHERE cell = ?");
  if (!found.bind(cell->id).step() ||
      digest_of_row(found, 1, found.columns()) != cell->details[detail_number("trace")]) {
    throw_damaged(file_, "the trace of " + label_of(*cell) + " is");
  }
  CellTrace out;
  found.integer();  // cell
  out.times = from_text<metrics::Times>(found.text()).value_or(metrics::Times::dense);
  out.samples = from_blob<TraceSample>(found.blob());
  return out;
}

std::vector<methods::Section> Traces::sections(std::int64_t position) {
  const auto found = by_position_.find(position);
  return found == by_position_.end() ? std::vector<methods::Section>{} : sections_[found->second];
}

std::optional<SequenceTrace> Traces::sequence(std::int64_t position) {
  const CellRow* cell = row(position);
  if (cell == nullptr) return std::nullopt;
  const auto sequence = sequences_.by_key.find(cell->sequence_key);
  if (sequence == sequences_.by_key.end()) return std::nullopt;
  if (sequence->second.trace_digest.empty()) return std::nullopt;
  Statement found = database_.prepare("SELECT * FROM sequence_trace WHERE sequence_key = ?");
  if (!found.bind(cell->sequence_key).step() ||
      digest_of_columns(found, 1, found.columns()) != sequence->second.trace_digest) {
    throw_damaged(file_, "the trace of sequence " + cell->sequence + " is");
  }
  SequenceTrace out;
  found.text();  // sequence_key
  for (double* number : {&out.origin.stamp, &out.origin.x, &out.origin.y, &out.origin.z}) {
    *number = found.real();
  }
  out.reference = from_blob<TracePose>(found.blob());
  out.keyframes = from_blob<TracePose>(found.blob());
  out.closures = from_blob<TraceClosure>(found.blob());
  return out;
}

}  // namespace loopbench::harness
