/// Checksums of the rows of a cell. A cell whose checksum does not match has changed since it was
/// written: readers reject it, and `run` computes it again.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <unordered_map>

#include "harness/store/sqlite.hpp"

namespace loopbench::harness {

/// The tables of what a method reported; columns: cell, number, then the content; and of its trace.
inline constexpr std::array kReportTables{"phase", "count", "note", "section", "trace"};

/// Query of their rows: of a trace only its checksum, of the others all columns.
std::string report_query(const std::string& table, const std::string& rest);

/// Sum of checksums without regard to order, with wrap-around.
using Checksum = std::uint64_t;

Checksum checksum_of(std::string_view bytes);

/// Of several texts or blobs, in that order.
std::int64_t checksum_of_parts(std::initializer_list<std::string_view> parts);

/// Columns of the table cell that checksums and readers use, after id, checksum and
/// report_checksum.
extern const char* const kCellColumns;

/// Of a row of "SELECT id, checksum, report_checksum, kCellColumns FROM cell".
Checksum checksum_of_cell(Statement& row, Checksum sequence);

/// Of each row of the table sequence, by sequence_key. O(rows).
std::unordered_map<std::string, Checksum> sequence_checksums(Database& database,
                                                             const std::string& schema = "main");

/// Of each definition of a score, by id, so that another database can number them differently.
std::unordered_map<std::int64_t, Checksum> definition_checksums(Database& database);

/// The query of score_value in the order of add_score().
inline constexpr const char* kScoreColumns =
    "cell, definition, number, count, rmse, mean, median, std, min, max, sse, pairs, possible, "
    "span, status, why";

/// Appends the content of a row "SELECT kScoreColumns FROM score_value".
void add_score(Statement& row,
               std::int64_t definition,
               const std::unordered_map<std::int64_t, Checksum>& definitions,
               std::string& bytes);

/// Of the rows of one cell in a report table, from the bytes of their columns from `number` on;
/// empty: no rows.
Checksum checksum_of_report(const char* table, std::string_view bytes);

/// Writes the checksums of cells from their stored rows.
class ChecksumWriter {
 public:
  explicit ChecksumWriter(Database& database);

  /// Of a new cell, after all its rows are written. O(rows of the cell).
  void write(std::int64_t cell);

  /// After a change of labels or position of an intact cell, whose row had the checksum `before`.
  void update_row(std::int64_t cell, Checksum before);

  /// Call after a transaction was rolled back.
  void forget_definitions() { definitions_.clear(); }

 private:
  Checksum row_of(std::int64_t cell);
  Checksum scores_of(std::int64_t cell);
  Checksum reports_of(std::int64_t cell);

  Statement row_;
  Statement sequence_;
  Statement scores_;
  Statement definition_;
  std::array<Statement, kReportTables.size()> reports_;
  Statement set_;
  Statement stored_;
  Statement set_row_;
  std::unordered_map<std::int64_t, Checksum> definitions_;
};

}  // namespace loopbench::harness
