/// Tables as CSV and JSON.
#pragma once

#include <string>
#include <vector>

#include "harness/tables/pivot.hpp"
#include "harness/tables/table_view.hpp"

namespace loopbench::harness {

/// A CSV field, quoted if necessary (RFC 4180). Control characters and bytes that are not UTF-8 are
/// escaped as by printable(). A text that a spreadsheet would evaluate (it begins with = or @, or
/// with + or - and is no number) gets a leading apostrophe, which spreadsheets hide.
std::string quoted(const std::string& text);

std::string markdown(const Table& table);
std::string markdown(const std::vector<Table>& tables);

/// One CSV with the split columns first (RFC 4180 quoting), numbers in full precision; `mark` is
/// best, second or empty.
std::string csv(const std::vector<Table>& tables);

/// The long table: one line per record with all columns.
std::string csv(const std::vector<Record>& records);

/// Its first line, and the line of one record.
extern const char* const kRowsHeader;
std::string csv_row(const Record& record);

/// Array of {title, row_names, columns, rows, notes, cells[row][column] {value, records, status,
/// mark}}; value is null unless status is ok.
std::string json(const std::vector<Table>& tables);

}  // namespace loopbench::harness
