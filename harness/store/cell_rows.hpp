/// Rows of a store, each checked against its digest.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/store/sqlite.hpp"

namespace loopbench::harness {

struct CellRow {
  std::int64_t id = 0;
  bool placed = false;  ///< part of the current config
  std::string sequence_key;
  std::int64_t failed_scores = 0;
  std::array<std::string, 6> details;  ///< digests of its rows by detail_number()
  std::string digest;
  bool intact = false;  ///< unchanged since it was written, as far as checked
  CellRecord record;    ///< without phases, counts, notes and sequence data
};

struct CellRows {
  std::vector<CellRow> cells;  ///< by id
  bool complete = false;       ///< no row is missing: the digests match the stored sum
};

/// Reads the table cell. O(cells).
CellRows read_cell_rows(Database& database);

/// Visits every row of `table` (score, phase, count, note or section) whose cell exists, in order
/// of writing, from its second column; then marks the damaged cells. O(rows).
void read_details(Database& database,
                  const std::string& table,
                  CellRows& rows,
                  const std::function<void(std::size_t cell, Statement& row)>& each = {});

/// Index of a table (score, phase, count, note, section or trace) in CellRow::details.
std::size_t detail_number(const std::string& table);

/// Throws InputError naming the first damaged cell, or if a cell is missing.
void require_intact(const CellRows& rows, const std::filesystem::path& file);

/// Throws InputError naming the corrupted part `what` of `file`.
[[noreturn]] void throw_damaged(const std::filesystem::path& file, const std::string& what);

/// "SEQUENCE / METHOD" or "SEQUENCE (repeat N) / METHOD".
std::string label_of(const CellRecord& cell);

/// Indices in `rows.cells` of the cells of the current config, in sweep order.
std::vector<std::size_t> in_order(const CellRows& rows);

}  // namespace loopbench::harness
