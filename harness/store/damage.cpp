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
    if (found[sequence_key] != sequence.trace_digest) sequence.whole = false;
  }
}

bool all_whole(const SequenceRows& sequences) {
  return std::ranges::all_of(sequences.by_key,
                             [](const auto& entry) { return entry.second.whole; });
}

Sound look(Database& database, bool traces) {
  Sound out;
  out.cells = read_cell_rows(database);
  for (const char* table : {"score", "phase", "count", "note", "section"}) {
    read_details(database, table, out.cells);
  }
  out.sequences = read_sequence_rows(database);
  if (traces) {
    read_details(database, "trace", out.cells);
    check_sequence_traces(database, out.sequences);
  }
  const bool lost = !out.sequences.complete || !all_whole(out.sequences);
  for (CellRow& cell : out.cells.cells) {
    const auto sequence = out.sequences.by_key.find(cell.sequence_key);
    if (sequence != out.sequences.by_key.end()) {
      if (!sequence->second.whole) cell.whole = false;
      continue;
    }
    // Only a failed cell can have none, because its sequence could not be loaded.
    const auto status = from_text<Status>(cell.record.status);
    if (lost && !(status && is_failure(*status))) cell.whole = false;
  }
  return out;
}

bool is_whole(const Sound& found) {
  return found.cells.complete && found.sequences.complete &&
         std::ranges::all_of(found.cells.cells, &CellRow::whole) && all_whole(found.sequences);
}

void remove(Database& database, const Sound& found) {
  for (const CellRow& cell : found.cells.cells) {
    if (!cell.whole) remove_cell(database, cell.id);
  }
  // Rows of a removed cell must not be assigned to a later cell with the same id.
  for (const char* table : {"score", "phase", "count", "note", "section", "trace"}) {
    database.execute(std::string("DELETE FROM ") + table +
                     " WHERE cell NOT IN (SELECT id FROM cell)");
  }
  for (const auto& [sequence_key, sequence] : found.sequences.by_key) {
    if (sequence.whole) continue;
    for (const char* table : {"input", "sequence", "sequence_trace"}) {
      database.prepare(std::string("DELETE FROM ") + table + " WHERE sequence_key = ?")
          .bind(sequence_key)
          .run();
    }
  }
  renew_sum(database, "cell");
  renew_sum(database, "sequence");
}

}  // namespace

Sound remove_damaged(Database& database, const std::filesystem::path& file, bool traces) {
  require_whole_texts(database, "run", file);
  require_whole_texts(database, "provenance", file);
  if (traces) database.execute("REINDEX");
  Sound found = look(database, traces);
  if (is_whole(found)) return found;
  remove(database, found);
  Sound out = look(database, traces);
  if (!is_whole(out)) {
    throw InputError(
        file.string() +
        ": is damaged and cannot be repaired; --fresh keeps it as previous.sqlite and starts "
        "a new store");
  }
  for (const CellRow& cell : found.cells.cells) {
    if (!cell.whole) out.removed.push_back(label_of(cell.record));
  }
  out.lost = !found.cells.complete;
  return out;
}

void require_whole_store(const std::filesystem::path& file) {
  Database database = open_store(file);
  for (const char* table : {"run", "provenance"}) require_whole_texts(database, table, file);
  const Sound found = look(database, true);
  require_whole(found.sequences, file);
  require_whole(found.cells, file);
}

void require_whole_texts(Database& database,
                         const std::string& table,
                         const std::filesystem::path& file) {
  if (digest_of_texts(database, table) == written_digest(database, table)) return;
  throw InputError(file.string() + ": is damaged: its table " + table +
                   " is not as written; run 'loopbench run' with its config and '--fresh', which "
                   "keeps this store as previous.sqlite");
}

}  // namespace loopbench::harness
