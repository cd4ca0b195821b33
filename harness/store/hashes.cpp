#include "harness/store/hashes.hpp"

#include "datasets/core/error.hpp"

namespace loopbench::harness {
namespace {

/// Continues a hash with the rows of a cell, those of its trace or the others.
std::uint64_t add_rows(Database& database, std::uint64_t hash, std::int64_t id, bool of_trace) {
  for (const CellTable& table : kCellTables) {
    if (table.is_trace != of_trace) continue;
    Statement row = database.prepare(std::string("SELECT ") + table.columns + " FROM " +
                                     table.name + " WHERE cell = ? ORDER BY 1");
    row.bind(id);
    while (row.step()) hash = row.hashed(hash, 0);
  }
  return hash;
}

}  // namespace

std::uint64_t trace_hash(Database& database, std::int64_t id) {
  return add_rows(database, 0, id, true);
}

void set_hashes(Database& database, std::int64_t id) {
  database.prepare("UPDATE cell SET trace_hash = ? WHERE id = ?")
      .bind(trace_hash(database, id), id)
      .run();
  Statement own = database.prepare(std::string("SELECT ") + kCellColumns + ", " + kSequenceColumns +
                                   " FROM " + kCellsWithSequences + " WHERE cell.id = ?");
  own.bind(id).step();
  database.prepare("UPDATE cell SET hash = ? WHERE id = ?")
      .bind(add_rows(database, own.hashed(0, 0), id, false), id)
      .run();
}

std::set<std::string> damaged_rows(Database& database, const SharedTable& table) {
  std::set<std::string> out;
  Statement row =
      database.prepare(std::string("SELECT row_hash, ") + table.columns + " FROM " + table.name);
  while (row.step()) {
    std::uint64_t hash = 0;
    row.read(hash);
    if (row.hashed(0, 1) != hash) out.insert(row.text());
  }
  return out;
}

std::set<std::string> remove_damaged_rows(Database& database, const SharedTable& table) {
  const std::string columns = table.columns;
  const std::set<std::string> out = damaged_rows(database, table);
  Statement remove = database.prepare(std::string("DELETE FROM ") + table.name + " WHERE " +
                                      columns.substr(0, columns.find(',')) + " = ?");
  for (const std::string& key : out) remove.bind(key).run();
  return out;
}

void require_intact_descriptions(Database& database) {
  for (const SharedTable& table : {kRunTable, kProvenanceTable, kInputTable}) {
    const std::set<std::string> damaged = damaged_rows(database, table);
    if (damaged.empty()) continue;
    throw_damaged(database.file(),
                  "row " + *damaged.begin() + " of its table " + table.name + " is");
  }
}

std::set<std::int64_t> intact_definitions(Database& database) {
  std::set<std::int64_t> out;
  Statement row =
      database.prepare(std::string("SELECT id, ") + kDefinitionColumns + " FROM score_definition");
  while (row.step()) {
    const std::int64_t id = row.integer();
    if (id == definition_id(row.hashed(0, 1))) out.insert(id);
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
