#include "harness/store/read.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "harness/store/cell_rows.hpp"
#include "harness/store/damage.hpp"
#include "harness/store/open.hpp"
#include "harness/store/record_reader.hpp"
#include "harness/store/sequence_rows.hpp"

namespace loopbench::harness {
namespace {

/// Removes the records of unused cells and sorts the others, without a second copy in memory.
void put_in_order(const std::vector<CellRow>& cells, std::vector<CellRecord>& records) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!cells[i].placed) continue;
    if (kept != i) records[kept] = std::move(records[i]);
    ++kept;
  }
  records.resize(kept);
  if (std::ranges::is_sorted(records, {}, &CellRecord::position)) return;
  std::ranges::stable_sort(records, {}, &CellRecord::position);
}

std::vector<CellRecord> cell_records(const std::filesystem::path& file, WithRecords with) {
  Database database = open_store(file);
  CellRows rows = read_cell_rows(database, with);
  const auto record = [&](std::size_t cell) -> CellRecord& { return rows.records[cell]; };
  read_details(database, "phase", rows, [&](std::size_t cell, Statement& row) {
    std::string name = row.text();
    record(cell).phases.push_back({std::move(name), row.real()});
  });
  read_details(database, "count", rows, [&](std::size_t cell, Statement& row) {
    std::string name = row.text();
    record(cell).counts.push_back({std::move(name), row.real()});
  });
  if (with == WithRecords::yes) {
    read_details(database, "note", rows, [&](std::size_t cell, Statement& row) {
      record(cell).notes.push_back(row.text());
    });
  }
  require_intact(rows, store_file(file));
  const SequenceRows sequences = read_sequence_rows(database);
  require_intact(sequences, store_file(file));
  for (std::size_t cell = 0; cell < rows.cells.size(); ++cell) {
    const auto found = sequences.by_key.find(rows.cells[cell].sequence_key);
    if (found == sequences.by_key.end()) continue;
    record(cell).keyframes = found->second.keyframes;
    record(cell).closure_count = found->second.closures;
  }
  put_in_order(rows.cells, rows.records);
  return std::move(rows.records);
}

}  // namespace

std::vector<Record> read_records(const std::filesystem::path& file) {
  std::vector<Record> out;
  RecordReader(file).for_each_chunk([&](std::vector<Record>& records) {
    std::ranges::move(records, std::back_inserter(out));
    return true;
  });
  return out;
}

std::vector<CellRecord> read_cells(const std::filesystem::path& file) {
  return cell_records(file, WithRecords::yes);
}

std::vector<CellRecord> read_costs(const std::filesystem::path& file) {
  return cell_records(file, WithRecords::costs);
}

std::map<std::string, std::string> read_run(const std::filesystem::path& file) {
  Database database = open_store(file);
  require_intact_texts(database, "run", store_file(file));
  Statement rows = database.prepare("SELECT key, value FROM run NOT INDEXED");
  std::map<std::string, std::string> out;
  while (rows.step()) {
    std::string key = rows.text();
    out.emplace(std::move(key), rows.text());
  }
  return out;
}

}  // namespace loopbench::harness
