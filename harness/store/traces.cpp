#include "harness/store/traces.hpp"

#include <bit>
#include <cstring>

#include "datasets/core/error.hpp"
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
    : database_(open_store(file)), cells_(read_cell_rows(database_)), sections_(cells_.size()) {
  check_reports(database_, cells_, [&](const std::string& table, std::size_t i, Statement& row) {
    if (table != "section") return;
    methods::Section& section = sections_[i].emplace_back();
    section.kind = row.text();
    section.begin = row.real();
    section.end = row.real();
    section.what = row.text();
  });
  require_intact(database_, cells_);
  database_.execute("COMMIT");  // a report takes long and must not block writers
  for (const std::size_t i : in_order(cells_)) by_position_.emplace(cells_[i].position, i);
}

const StoredCell* Traces::row(std::int64_t position) const {
  const auto found = by_position_.find(position);
  return found == by_position_.end() ? nullptr : &cells_[found->second];
}

std::optional<CellTrace> Traces::cell(std::int64_t position) {
  const StoredCell* cell = row(position);
  if (cell == nullptr) return std::nullopt;
  Statement found = database_.prepare("SELECT times, samples, checksum FROM trace WHERE cell = ?");
  if (!found.bind(cell->id).step()) return std::nullopt;
  const std::string times = found.text();
  const std::string samples = found.blob();
  if (checksum_of_parts({times, samples}) != found.integer()) {
    throw_damaged(database_.file(), "the trace of " + label_of(*cell) + " is");
  }
  CellTrace out;
  out.times = from_text<metrics::Times>(times).value_or(metrics::Times::dense);
  out.samples = from_blob<TraceSample>(samples);
  return out;
}

std::vector<methods::Section> Traces::sections(std::int64_t position) {
  const auto found = by_position_.find(position);
  return found == by_position_.end() ? std::vector<methods::Section>{} : sections_[found->second];
}

std::optional<SequenceTrace> Traces::sequence(std::int64_t position) {
  const StoredCell* cell = row(position);
  if (cell == nullptr) return std::nullopt;
  Statement found = database_.prepare("SELECT * FROM sequence_trace WHERE sequence_key = ?");
  if (!found.bind(cell->sequence_key).step()) return std::nullopt;
  found.text();  // sequence_key
  SequenceTrace out;
  for (double* number : {&out.origin.stamp, &out.origin.x, &out.origin.y, &out.origin.z}) {
    *number = found.real();
  }
  const std::string reference = found.blob();
  const std::string keyframes = found.blob();
  const std::string closures = found.blob();
  if (checksum_of_parts({reference, keyframes, closures}) != found.integer()) {
    throw_damaged(database_.file(), "the trace of sequence " + cell->sequence + " is");
  }
  out.reference = from_blob<TracePose>(reference);
  out.keyframes = from_blob<TracePose>(keyframes);
  out.closures = from_blob<TraceClosure>(closures);
  return out;
}

}  // namespace loopbench::harness
