/// The cells of a store, and damage to their rows.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/store/sqlite.hpp"

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

/// Removes the cell with that id from every table.
void remove_cell(Database& database, std::int64_t id);

/// If cells were lost with a damaged page, removes their rows in other tables: they would belong to
/// a later cell with the same id. Call within a transaction.
void remove_orphans(Database& database);

/// "SEQUENCE / METHOD" or "SEQUENCE (repeat N) / METHOD".
std::string label_of(const CellRow& cell);

}  // namespace loopbench::harness
