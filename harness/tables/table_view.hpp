/// A formatted table: text only, common to all output formats.
#pragma once

#include <string>
#include <vector>

#include "harness/tables/mark_best.hpp"
#include "harness/tables/pivot.hpp"

namespace loopbench::harness {

struct TableViewEntry {
  std::string text;
  Mark mark = Mark::none;
};

/// The first column has the row names and is left-aligned; the others are right-aligned numbers.
struct TableView {
  std::string title;
  std::vector<std::string> headings;
  std::vector<std::vector<TableViewEntry>> lines;  ///< [row][column]
  std::vector<std::string> notes;                  ///< one per line, below the table
};

/// Number of decimals of a column: four significant digits for its largest value.
int decimals(double largest);

/// `value` with that many decimals; -0.00 is printed as 0.00.
std::string fixed(double value, int digits);

/// Formats a table's numbers with the decimals of each column.
TableView table_view(const Table& table);

/// GitHub Markdown, padded for reading on a terminal. Best in bold, second best in italics.
/// Markdown and HTML markup is escaped.
std::string markdown(const TableView& table_view);

/// Aligned columns without markup: `*` after the best, `+` after the second best.
std::string terminal(const TableView& table_view);

/// A booktabs tabular with its caption and notes as comments. Best in bold, second best underlined.
/// Escaped; needs \usepackage{booktabs} and UTF-8.
std::string latex(const TableView& table_view);

/// Width on a terminal: code points, not bytes.
std::size_t width(const std::string& text);

/// Padded with spaces to that width.
std::string padded(const std::string& text, std::size_t columns, bool left);

/// Replaces line breaks, tabs and other control characters by spaces.
std::string one_line(const std::string& text);

/// Width of the widest text of each column, including headings, after `escaped` is applied to text
/// and marks.
std::vector<std::size_t> widths(const std::vector<std::vector<std::string>>& lines);

}  // namespace loopbench::harness
