/// The rows of a store, each held against its digest.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/store/sqlite.hpp"

namespace loopbench {

struct CellRow {
  std::int64_t id = 0;
  bool placed = false;  ///< the config asks for it
  std::string sequence_key;
  std::int64_t failed_scores = 0;
  std::array<std::string, 6> details;  ///< digests of its rows by detail_number()
  std::string digest;
  bool whole = false;  ///< is, as far as was looked at, what was written
  CellRecord record;   ///< without phases, counts, notes and what its sequence knows
};

struct CellRows {
  std::vector<CellRow> cells;  ///< by id
  bool complete = false;       ///< none was lost: their digests sum up to what was written
};

/// The table cell. O(cells).
CellRows read_cell_rows(Database& database);

/// Every row of `table` (score, phase, count, note or section) whose cell is there, in the order of
/// writing, at its second column; then marks the cells that are not whole. O(rows).
void read_details(Database& database,
                  const std::string& table,
                  CellRows& rows,
                  const std::function<void(std::size_t cell, Statement& row)>& each = {});

/// Place of a table (score, phase, count, note, section or trace) in CellRow::details.
std::size_t detail_number(const std::string& table);

/// Throws InputError naming the first cell that is not whole, or when one was lost.
void require_whole(const CellRows& rows, const std::filesystem::path& file);

/// Throws InputError: `what` in `file` is not what was written.
[[noreturn]] void refuse_damaged(const std::filesystem::path& file, const std::string& what);

/// "SEQUENCE / METHOD" or "SEQUENCE (repeat N) / METHOD".
std::string label_of(const CellRecord& cell);

/// Positions in `rows.cells` of the cells that the config asks for, in the order of the sweep.
std::vector<std::size_t> in_order(const CellRows& rows);

}  // namespace loopbench
