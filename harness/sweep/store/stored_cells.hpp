/// The cells of a store, the hashes of their rows and of rows that they share, and damage to them.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "harness/sweep/model/record.hpp"
#include "harness/sweep/store/schema.hpp"
#include "harness/sweep/store/sqlite.hpp"

namespace loopbench::harness {

/// A row of the table cell and its sequence. Phases, counts, notes and sections are not set.
struct StoredCell : CellRow {
  std::int64_t id = 0;
  SharedText sequence_key;
  std::int64_t failed_scores = 0;
  std::int64_t scores = 0;  ///< number of rows in score_value
  std::uint64_t hash = 0;
  std::uint64_t trace_hash = 0;
  bool placed = false;  ///< part of the current config; otherwise it has no position
  bool intact = true;   ///< nothing of it has changed, its sequence, input files and provenance
                        ///< included; traces are checked by check_traces()
};

/// Number of cells of the store according to its writers. A damaged page can lose cells.
std::int64_t written_cells(Database& database);

/// All cells by id. O(scores), about 500 bytes of memory for each cell.
std::vector<StoredCell> read_stored_cells(Database& database);

/// The cells of the current config in sweep order. Throws InputError naming the first cell that is
/// damaged, or if cells are missing.
std::vector<StoredCell> read_intact_cells(Database& database);

/// Clears `intact` of the cells whose traces, or those of their sequences, have changed or are
/// missing. `cells`: all of the store, by id. O(bytes).
void check_traces(Database& database, std::vector<StoredCell>& cells);

/// Throws InputError unless all rows of all cells are intact. O(bytes).
void require_intact(Database& database);

/// Rebuilds the indices if they miss rows: those of cells and their descriptions, or of `all`
/// tables. Throws InputError if that is not enough. Call within a transaction.
/// O(cells log(cells)), or O(bytes).
void repair_structure(Database& database, bool all);

/// Removes the cell with that id from every table.
void remove_cell(Database& database, std::int64_t id);

/// If cells were lost with a damaged page, removes their rows in other tables: they would belong to
/// a later cell with the same id. Call within a transaction.
void remove_orphans(Database& database);

/// "SEQUENCE / METHOD" or "SEQUENCE (repeat N) / METHOD".
std::string label_of(const CellRow& cell);

/// Sets the hashes of a cell. Call after any of its rows has changed. O(bytes).
void set_hashes(Database& database, std::int64_t id);

/// Hash of the rows of a cell's trace. O(bytes).
std::uint64_t trace_hash(Database& database, std::int64_t id);

/// The first columns of the rows that have changed. O(bytes).
std::set<std::string> damaged_rows(Database& database, const SharedTable& table);

/// Removes the rows with these keys, and returns the keys.
std::set<std::string> remove_damaged_rows(Database& database, const SharedTable& table);

/// Throws InputError naming the first row of run, provenance or input that has changed.
void require_intact_descriptions(Database& database);

/// Ids of the definitions of scores that have not changed, sorted.
std::vector<std::int64_t> intact_definitions(Database& database);

/// Sets a value of the table run.
void set_run_value(Database& database, const std::string& key, const std::string& value);

/// Throws InputError naming the part `what` of `file` that has changed.
[[noreturn]] void throw_damaged(const std::string& file, const std::string& what);

}  // namespace loopbench::harness
