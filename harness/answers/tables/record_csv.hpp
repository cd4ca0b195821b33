/// Records as CSV.
#pragma once

#include <string>
#include <vector>

#include "harness/sweep/model/record.hpp"

namespace loopbench::harness {

/// A CSV field, quoted if necessary (RFC 4180). Control characters and bytes that are not UTF-8 are
/// escaped as by printable(). A text that a spreadsheet would evaluate (it begins with = or @, or
/// with + or - and is no number) gets a leading apostrophe, which spreadsheets hide.
std::string quoted(const std::string& text);

/// The long table: one line per record.
std::string csv(const std::vector<Record>& records);

/// Its first line, and the line of one record.
std::string rows_header();
std::string csv_row(const Record& record);

}  // namespace loopbench::harness
