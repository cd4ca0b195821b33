#include "harness/store/damage.hpp"

#include <algorithm>

#include "datasets/core/error.hpp"
#include "harness/model/result.hpp"
#include "harness/store/cell_writer.hpp"
#include "harness/store/digest.hpp"
#include "harness/store/open.hpp"
#include "harness/store/write_digests.hpp"

namespace loopbench::harness {
namespace {

void check_sequence_traces(Database& database, SequenceRows& sequences) {
  std::map<std::string, std::string> found;
  Statement row = database.prepare("SELECT * FROM sequence_trace NOT INDEXED");
  while (row.step()) {
    const std::string digest = digest_of_columns(row, 1, row.columns());
    found[row.text()] = digest;
  }
  for (auto& [sequence_key, sequence] : sequences.by_key) {
    if (found[sequence_key] != sequence.trace_digest) sequence.intact = false;
  }
}

bool all_intact(const SequenceRows& sequences) {
  return std::ranges::all_of(sequences.by_key,
                             [](const auto& entry) { return entry.second.intact; });
}

bool is_intact(const CheckedStore& found) {
  return found.cells.complete && found.sequences.complete &&
         std::ranges::all_of(found.cells.cells, &CellRow::intact) && all_intact(found.sequences);
}

void remove(Database& database, const CheckedStore& found) {
  for (const CellRow& cell : found.cells.cells) {
    if (!cell.intact) remove_cell(database, cell.id);
  }
  for (const auto& [sequence_key, sequence] : found.sequences.by_key) {
    if (sequence.intact) continue;
    for (const char* table : {"input", "sequence", "sequence_trace"}) {
      database.prepare(std::string("DELETE FROM ") + table + " WHERE sequence_key = ?")
          .bind(sequence_key)
          .run();
    }
  }
  remove_orphans(database);
  database.execute(
      "DELETE FROM score_definition WHERE id NOT IN (SELECT definition FROM score_value)");
  update_sum(database, "cell");
  update_sum(database, "sequence");
}

}  // namespace

void remove_orphans(Database& database) {
  // They would be assigned to a later cell with the same id.
  for (const char* table : {"score_value", "phase", "count", "note", "section", "trace"}) {
    database.execute(std::string("DELETE FROM ") + table +
                     " WHERE cell NOT IN (SELECT id FROM cell)");
  }
  for (const char* table : {"input", "sequence_trace"}) {
    database.execute(std::string("DELETE FROM ") + table +
                     " WHERE sequence_key NOT IN (SELECT sequence_key FROM sequence)");
  }
}

CheckedStore check_rows(Database& database, bool traces) {
  CheckedStore out;
  out.cells = read_cell_rows(database);
  check_scores(database, ScoreDefinitions(database), out.cells);
  for (const char* table : {"phase", "count", "note", "section"}) {
    read_details(database, table, out.cells);
  }
  out.sequences = read_sequence_rows(database);
  if (traces) {
    read_details(database, "trace", out.cells);
    check_sequence_traces(database, out.sequences);
  }
  const bool lost = !out.sequences.complete || !all_intact(out.sequences);
  auto sequence = out.sequences.by_key.end();
  SharedText last;  // cells of one sequence mostly follow each other
  for (CellRow& cell : out.cells.cells) {
    if (cell.sequence_key != last || last.empty()) {
      last = cell.sequence_key;
      sequence = out.sequences.by_key.find(last);
    }
    if (sequence != out.sequences.by_key.end()) {
      if (!sequence->second.intact) cell.intact = false;
      continue;
    }
    // Only a failed cell can have none, because its sequence could not be loaded.
    if (lost && !is_failure(cell.status)) cell.intact = false;
  }
  return out;
}

CheckedStore remove_damaged(Database& database, const std::filesystem::path& file, bool traces) {
  require_intact_texts(database, "run", file);
  require_intact_texts(database, "provenance", file);
  if (traces) database.execute("REINDEX");
  CheckedStore found = check_rows(database, traces);
  if (is_intact(found)) return found;
  remove(database, found);
  CheckedStore out = check_rows(database, traces);
  if (!is_intact(out)) {
    throw InputError(file.string() + ": is damaged and cannot be repaired; " +
                     recovery_advice(file));
  }
  for (const CellRow& cell : found.cells.cells) {
    if (!cell.intact) out.removed.push_back(label_of(cell));
  }
  out.lost = !found.cells.complete;
  return out;
}

void require_intact_store(const std::filesystem::path& file) {
  Database database = open_store(file);
  for (const char* table : {"run", "provenance"}) require_intact_texts(database, table, file);
  const CheckedStore found = check_rows(database, true);
  require_intact(found.sequences, file);
  require_intact(found.cells, file);
}

void require_intact_texts(Database& database,
                          const std::string& table,
                          const std::filesystem::path& file) {
  if (digest_of_texts(database, table) == written_digest(database, table)) return;
  throw InputError(file.string() + ": is damaged: its table " + table + " is corrupted; " +
                   recovery_advice(file));
}

}  // namespace loopbench::harness
