#include "harness/sweep/store/stored_cells.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>

#include "datasets/core/error.hpp"
#include "harness/sweep/store/missing_rows.hpp"
#include "harness/sweep/store/row_hashes.hpp"

namespace loopbench::harness {
namespace {

/// Whether SQLite finds no error in these tables (names in parentheses, or "" for all). Hashes
/// protect only rows that are found, and a damaged index hides some.
bool has_sound_structure(Database& database, const std::vector<std::string>& tables) {
  return std::ranges::all_of(tables, [&](const std::string& table) {
    Statement row = database.prepare("PRAGMA integrity_check" + table);
    return row.step() && row.text() == "ok";
  });
}

const std::vector<std::string> kSearched{
    "(run)", "(provenance)", "(input)", "(sequence)", "(sequence_note)", "(cell)"};

void require_none_damaged(Database& database, const std::vector<StoredCell>& cells) {
  const auto damaged = std::ranges::count(cells, false, &StoredCell::intact);
  if (damaged > 0) {
    const std::string more = std::to_string(damaged - 1);
    throw_damaged(database.file(),
                  label_of(*std::ranges::find(cells, false, &StoredCell::intact)) +
                      (damaged == 1 ? " is" : " and " + more + " more are"));
  }
  if (written_cells(database) != std::ssize(cells) || !has_sound_structure(database, kSearched)) {
    throw_damaged(database.file(), "the structure of its tables is");
  }
}

/// Number of rows of each list of notes, without lists that have a damaged row.
std::map<std::string, std::int64_t> sizes_of_notes(Database& database) {
  std::map<std::string, std::int64_t> out;
  Statement row =
      database.prepare("SELECT notes_key, count(*) FROM sequence_note GROUP BY notes_key");
  while (row.step()) {
    std::string key;
    std::int64_t count = 0;
    row.read(key, count);
    out.emplace(key, count);
  }
  for (const std::string& key : damaged_rows(database, kSequenceNoteTable)) out.erase(key);
  return out;
}

void read_field(Statement& row, Status& value) {
  value = from_text<Status>(row.text()).value_or(Status::failed);
}
void read_field(Statement& row, GroupKind& value) {
  value = from_text<GroupKind>(row.text()).value_or(GroupKind::none);
}
void read_field(Statement& row, bool& value) { value = row.integer() != 0; }
template <class Value>
void read_field(Statement& row, Value& value) {
  row.read(value);
}

}  // namespace

std::int64_t written_cells(Database& database) {
  return database.integer("SELECT value FROM run WHERE key = 'cells'");
}

std::vector<StoredCell> read_stored_cells(Database& database) {
  const std::set<std::string> damaged_provenance = damaged_rows(database, kProvenanceTable);
  const std::set<std::string> damaged_inputs = damaged_rows(database, kInputTable);
  std::map<std::string, std::int64_t> sizes = sizes_of_notes(database);
  const std::set<std::string> known_provenance = provenance_keys(database);
  std::vector<StoredCell> out;
  std::vector<std::uint64_t> hashes;
  Statement row = database.prepare(
      std::string("SELECT cell.id, hash, keyframes, sequence.closures, content, group_name, "
                  "group_kind, recording, ") +
      kCellColumns + ", " + kSequenceColumns + " FROM " + kCellsWithSequences +
      " ORDER BY cell.id");
  StoredCell c;
  SharedText provenance_key;
  while (row.step()) {
    hashes.push_back(row.hashed(0, 8));
    std::optional<std::int64_t> position;
    row.read(c.id, c.hash, c.keyframes, c.closure_count, c.content, c.group);
    read_field(row, c.group_kind);
    row.read(c.recording);
    row.read(position, c.key, c.build, c.sequence_key, provenance_key);
    std::string notes_key;
    std::int64_t notes = 0;
    row.read(notes_key, notes);
    fields(c, [&](const CellField&, auto& value) { read_field(row, value); });
    row.read(c.failed_scores, c.scores, c.trace_hash);
    c.intact = known_provenance.contains(provenance_key) &&
               !damaged_provenance.contains(provenance_key) &&
               !damaged_inputs.contains(c.sequence_key) &&
               notes == (notes_key.empty() ? 0 : sizes[notes_key]);
    c.placed = position.has_value();
    c.position = position.value_or(0);
    out.push_back(c);
  }
  check_rows(database, out, false, hashes);
  return out;
}

std::vector<StoredCell> read_intact_cells(Database& database) {
  std::vector<StoredCell> out = read_stored_cells(database);
  require_none_damaged(database, out);
  std::erase_if(out, [](const StoredCell& cell) { return !cell.placed; });
  std::ranges::stable_sort(out, {}, &StoredCell::position);
  return out;
}

void check_traces(Database& database, std::vector<StoredCell>& cells) {
  check_rows(database, cells, true, std::vector<std::uint64_t>(cells.size(), 0));
  const std::set<std::string> damaged = damaged_rows(database, kSequenceTraceTable);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells[i].intact = cells[i].intact && !damaged.contains(cells[i].sequence_key);
  }
}

void require_intact(Database& database) {
  std::vector<StoredCell> cells = read_stored_cells(database);
  check_traces(database, cells);
  require_none_damaged(database, cells);
}

void repair_structure(Database& database, bool all) {
  const std::vector<std::string> tables = all ? std::vector<std::string>{""} : kSearched;
  if (has_sound_structure(database, tables)) return;
  database.execute("REINDEX");
  if (has_sound_structure(database, tables)) return;
  throw InputError(database.file() + ": is damaged; " + kRecoverAdvice);
}

void remove_cell(Database& database, std::int64_t id) {
  for (const CellTable& table : kCellTables) {
    database.prepare(std::string("DELETE FROM ") + table.name + " WHERE cell = ?").bind(id).run();
  }
  database.prepare("DELETE FROM cell WHERE id = ?").bind(id).run();
}

void remove_orphans(Database& database) {
  const std::int64_t cells = database.integer("SELECT count(*) FROM cell");
  if (written_cells(database) == cells) return;
  set_run_value(database, "cells", std::to_string(cells));
  for (const CellTable& table : kCellTables) {
    database.execute(std::string("DELETE FROM ") + table.name +
                     " WHERE cell NOT IN (SELECT id FROM cell)");
  }
}

std::string label_of(const CellRow& cell) {
  std::string out = cell.name();
  for (char& c : out) {
    if (static_cast<unsigned char>(c) < 0x20) c = '?';  // in a damaged name
  }
  return out;
}

std::uint64_t trace_hash(Database& database, std::int64_t id) {
  return with_rows(database, 0, id, true);
}

void set_hashes(Database& database, std::int64_t id) {
  database.prepare("UPDATE cell SET trace_hash = ? WHERE id = ?")
      .bind(trace_hash(database, id), id)
      .run();
  Statement own = database.prepare(std::string("SELECT ") + kCellColumns + ", " + kSequenceColumns +
                                   " FROM " + kCellsWithSequences + " WHERE cell.id = ?");
  own.bind(id).step();
  database.prepare("UPDATE cell SET hash = ? WHERE id = ?")
      .bind(with_rows(database, own.hashed(0, 0), id, false), id)
      .run();
}

std::set<std::string> damaged_rows(Database& database, const SharedTable& table) {
  std::set<std::string> out;
  Statement row = database.prepare(std::string("SELECT row_hash, * FROM ") + table.name);
  while (row.step()) {
    std::uint64_t hash = 0;
    row.read(hash);
    if (row.hashed(0, 1, 1) != hash) out.insert(row.text());
  }
  if (std::string_view(table.name) == kProvenanceTable.name)
    out.merge(incomplete_provenance(database));
  return out;
}

std::set<std::string> remove_damaged_rows(Database& database, const SharedTable& table) {
  const std::set<std::string> out = damaged_rows(database, table);
  Statement remove =
      database.prepare(std::string("DELETE FROM ") + table.name + " WHERE " + table.key + " = ?");
  for (const std::string& key : out) remove.bind(key).run();
  return out;
}

void require_intact_descriptions(Database& database) {
  for (const SharedTable& table : {kRunTable, kProvenanceTable, kInputTable, kSequenceNoteTable}) {
    const std::set<std::string> damaged = damaged_rows(database, table);
    if (damaged.empty()) continue;
    throw_damaged(database.file(),
                  "row " + *damaged.begin() + " of its table " + table.name + " is");
  }
  if (const std::string missing = missing_run_value(database); !missing.empty()) {
    throw_damaged(database.file(), "row " + missing + " of its table run is");
  }
}

std::vector<std::int64_t> intact_definitions(Database& database) {
  std::vector<std::int64_t> out;
  Statement row = database.prepare("SELECT * FROM score_definition ORDER BY id");
  while (row.step()) {
    const std::int64_t id = row.integer();
    if (id == definition_id(row.hashed(0, 1))) out.push_back(id);
  }
  return out;
}

void set_run_value(Database& database, const std::string& key, const std::string& value) {
  database.prepare("INSERT OR REPLACE INTO run VALUES (?, ?, ?)").bind_hashed(key, value).run();
}

void throw_damaged(const std::string& file, const std::string& what) {
  throw InputError(file + ": is damaged: " + what +
                   " corrupted; 'loopbench run' with its config recomputes it");
}

}  // namespace loopbench::harness
