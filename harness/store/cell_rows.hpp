/// The cells of a store, and the check of their rows.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/store/checksum.hpp"
#include "harness/store/sqlite.hpp"

namespace loopbench::harness {

/// A row of the table cell. Sizes, phases, counts and notes are not set.
struct StoredCell : CellRecord {
  std::int64_t id = 0;
  SharedText sequence_key;
  SharedText provenance_key;
  std::int64_t failed_scores = 0;
  std::int64_t score_count = 0;  ///< set by check_scores()
  bool placed = false;           ///< part of the current config; otherwise it has no position
  bool intact = true;            ///< unchanged since it was written, as far as checked
  Checksum own = 0;              ///< of this row and its sequence
  Checksum checksum = 0;         ///< as stored: `own` plus that of its scores
  Checksum report_checksum = 0;  ///< as stored
};

/// All cells by id, unchecked except for the status. O(cells), about 500 bytes of memory each.
std::vector<StoredCell> read_cell_rows(Database& database);

/// Marks cells whose row, sequence or scores have changed since they were written. Large stores are
/// read on two threads. O(scores).
void check_scores(Database& database, std::vector<StoredCell>& cells);

/// Visits the rows of a report table, except traces, from the column after `number`.
using ReportVisit = std::function<void(const std::string& table, std::size_t cell, Statement& row)>;

/// Marks cells whose phases, counts, notes or sections have changed, or whose trace is missing.
/// O(rows).
void check_reports(Database& database,
                   std::vector<StoredCell>& cells,
                   const ReportVisit& visit = {});

/// Marks cells whose trace, or whose sequence's trace, has changed. O(bytes).
void check_traces(Database& database, std::vector<StoredCell>& cells);

/// Throws InputError naming the first cell that is not intact, or if cells are missing.
void require_intact(Database& database, const std::vector<StoredCell>& cells);

/// Number of cells of the store according to its writers. A damaged page can lose cells.
std::int64_t written_cells(Database& database);

/// Throws InputError naming the part `what` of `file` that has changed.
[[noreturn]] void throw_damaged(const std::string& file, const std::string& what);

/// "SEQUENCE / METHOD" or "SEQUENCE (repeat N) / METHOD".
std::string label_of(const CellRecord& cell);

/// Indices of the cells of the current config, in sweep order.
std::vector<std::size_t> in_order(const std::vector<StoredCell>& cells);

}  // namespace loopbench::harness
