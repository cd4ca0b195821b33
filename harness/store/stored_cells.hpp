/// The cells of a store, and damage to their rows.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/store/sqlite.hpp"

namespace loopbench::harness {

/// A row of the table cell and its sequence. Phases, counts, notes and sections are not set.
struct StoredCell : CellRecord {
  std::int64_t id = 0;
  SharedText group;  ///< of its sequence
  std::int64_t failed_scores = 0;
  std::int64_t scores = 0;       ///< number of rows in score_value
  std::int64_t report_rows = 0;  ///< number of rows in phase, count, note and section
  bool placed = false;           ///< part of the current config; otherwise it has no position
  bool intact = true;            ///< this row and that of its sequence have not changed
};

/// All cells by id. O(cells), about 500 bytes of memory each.
std::vector<StoredCell> read_stored_cells(Database& database);

/// The cells of the current config in sweep order. Throws InputError naming the first cell that is
/// damaged, or if cells are missing.
std::vector<StoredCell> read_intact_cells(Database& database);

/// Ids of the cells of which any row has changed or is missing, traces included. O(bytes).
std::vector<std::int64_t> damaged_cells(Database& database);

/// Throws InputError if a cell has another number of scores than were written. O(scores).
void require_all_scores(Database& database);

/// Throws InputError unless all rows of all cells are intact. O(bytes).
void require_intact(Database& database);

/// Throws InputError naming the part `what` of `file` that has changed.
[[noreturn]] void throw_damaged(const std::string& file, const std::string& what);

/// Removes the cell with that id from every table.
void remove_cell(Database& database, std::int64_t id);

/// If cells were lost with a damaged page, removes their rows in other tables: they would belong to
/// a later cell with the same id. Call within a transaction.
void remove_orphans(Database& database);

/// Sets the checksum of a cell from its row and its sequence.
Statement checksum_update(Database& database);

/// "SEQUENCE / METHOD" or "SEQUENCE (repeat N) / METHOD".
std::string label_of(const CellRecord& cell);

}  // namespace loopbench::harness
