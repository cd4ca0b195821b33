#include "harness/store/read.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "harness/store/cell_rows.hpp"
#include "harness/store/open.hpp"
#include "harness/store/record_reader.hpp"
#include "harness/store/sequence_rows.hpp"

namespace loopbench::harness {

std::vector<Record> read_records(const std::filesystem::path& file) {
  std::vector<Record> out;
  RecordReader(file).for_each_chunk([&](std::vector<Record>& records) {
    std::ranges::move(records, std::back_inserter(out));
    return true;
  });
  return out;
}

std::vector<CellRecord> read_cells(const std::filesystem::path& file) {
  Database database = open_store(file);
  std::vector<StoredCell> cells = read_cell_rows(database);
  check_scores(database, cells);
  check_reports(database, cells, [&](const std::string& table, std::size_t i, Statement& row) {
    CellRecord& cell = cells[i];
    const std::string text = row.text();
    if (table == "phase") cell.phases.push_back({text, row.real()});
    if (table == "count") cell.counts.push_back({text, row.real()});
    if (table == "note") cell.notes.push_back(text);
  });
  require_intact(database, cells);
  const SequenceRows sequences = read_sequence_rows(database);
  std::vector<CellRecord> out;
  for (const std::size_t i : in_order(cells)) {
    const auto sequence = sequences.find(cells[i].sequence_key);
    if (sequence != sequences.end()) {
      cells[i].keyframes = sequence->second.keyframes;
      cells[i].closure_count = sequence->second.closures;
    }
    out.push_back(std::move(cells[i]));
  }
  return out;
}

std::map<std::string, std::string> read_run(const std::filesystem::path& file) {
  Database database = open_store(file);
  Statement rows = database.prepare("SELECT key, value FROM run");
  std::map<std::string, std::string> out;
  while (rows.step()) {
    std::string key = rows.text();
    out.emplace(std::move(key), rows.text());
  }
  return out;
}

}  // namespace loopbench::harness
