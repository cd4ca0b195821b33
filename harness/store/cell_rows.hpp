/// Rows of a store, each checked against its digest.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/store/score_rows.hpp"
#include "harness/store/sqlite.hpp"
#include "harness/text/hash.hpp"

namespace loopbench::harness {

/// About 250 bytes: a store can have millions.
struct CellRow {
  std::int64_t id = 0;
  std::int64_t position = 0;  ///< in the sweep, if placed
  std::int64_t repeat = 0;
  std::int64_t failed_scores = 0;
  SharedText sequence_key;
  SharedText sequence;
  SharedText method;
  Status status = Status::ok;
  SharedText closures;
  SharedText why;
  double seconds = 0.0;         ///< CellRecord::seconds; NaN: not recorded, though it has results
  Hash key;                     ///< of the text of CellRecord::key
  std::array<Hash, 6> details;  ///< digests of its rows by detail_number(); zero: none
  Hash digest;
  bool oracle_closures = false;
  bool oracle = false;
  bool placed = false;  ///< part of the current config
  bool intact = false;  ///< unchanged since it was written, as far as checked
};

struct CellRows {
  std::vector<CellRow> cells;       ///< by id
  std::vector<CellRecord> records;  ///< parallel to cells, if requested; see read_cell_rows()
  bool complete = false;            ///< no row is missing: the digests match the stored sum
};

/// From this number of cells on, half of them are read through a second connection on another
/// thread.
inline constexpr std::int64_t kCellsWorthAThread = 8192;

/// Contents of CellRows::records: none; without key, build, options, signal and reason; or all.
/// Phases, counts, notes and sequence data are never read.
enum class WithRecords { no, costs, yes };

/// Reads the table cell. O(cells).
CellRows read_cell_rows(Database& database, WithRecords with = WithRecords::no);

/// Visits every row of `table` (phase, count, note, section or trace) whose cell exists, in order
/// of writing, from its second column; then marks the damaged cells. O(rows).
void read_details(Database& database,
                  const std::string& table,
                  CellRows& rows,
                  const std::function<void(std::size_t cell, Statement& row)>& each = {});

/// Marks cells whose scores or definitions of scores are damaged. O(scores).
void check_scores(Database& database, const ScoreDefinitions& definitions, CellRows& rows);

/// Index of a table (score_value, phase, count, note, section or trace) in CellRow::details.
std::size_t detail_number(const std::string& table);

/// Throws InputError naming the first damaged cell, or if a cell is missing.
void require_intact(const CellRows& rows, const std::filesystem::path& file);

/// Throws InputError naming the corrupted part `what` of `file`.
[[noreturn]] void throw_damaged(const std::filesystem::path& file, const std::string& what);

/// "SEQUENCE / METHOD" or "SEQUENCE (repeat N) / METHOD".
std::string label_of(const CellRecord& cell);
std::string label_of(const CellRow& cell);

/// Indices in `rows.cells` of the cells of the current config, in sweep order.
std::vector<std::size_t> in_order(const CellRows& rows);

}  // namespace loopbench::harness
