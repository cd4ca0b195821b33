/// A formatted table: text only, common to all output formats.
#pragma once

#include <concepts>
#include <string>
#include <vector>

#include "harness/tables/mark_best.hpp"
#include "harness/tables/pivot.hpp"

namespace loopbench::harness {

struct TableViewEntry {
  TableViewEntry() = default;
  template <std::convertible_to<std::string> Text>
  TableViewEntry(const Text& own_text, Mark own_mark = Mark::none)
      : text(own_text), mark(own_mark) {}

  std::string text;
  Mark mark = Mark::none;

  friend bool operator==(const TableViewEntry&, const TableViewEntry&) = default;
};

/// The first column has the row names and is left-aligned; the others are right-aligned.
struct TableView {
  std::string title;
  std::vector<std::string> headings;
  std::vector<std::vector<TableViewEntry>> lines;  ///< [row][column]
  std::vector<std::string> notes;                  ///< one per line, below the table
};

/// Properties of the terminal that a table is printed on.
struct TerminalStyle {
  std::size_t width = 0;  ///< in characters; 0: unlimited
  bool color = false;     ///< whether escape sequences for bold and colour are allowed
};

/// Number of decimals of a column: four significant digits for its largest value.
int decimals(double largest);

/// `value` with that many decimals; -0.00 is printed as 0.00.
std::string fixed(double value, int digits);

/// Formats a table's numbers with the decimals of each column, with the standard deviation of each
/// mean if the table has them. Columns without any value are left out if others have values: the
/// notes contain the reasons.
TableView table_view(const Table& table);

/// GitHub Markdown, padded for reading on a terminal. Best in bold, second best in italics.
/// Markdown and HTML markup is escaped.
std::string markdown(const TableView& table_view);

/// Aligned columns without markup: `*` after the best, `+` after the second best. If the table is
/// wider than the terminal, headings are broken into lines, row names shortened, and the columns
/// distributed over several blocks that each repeat the row names. Notes are wrapped.
std::string terminal(const TableView& table_view, const TerminalStyle& style = {});

/// A booktabs tabular, in a table with a caption if it has a title; notes as comments. Best in
/// bold, second best underlined. Escaped; needs \usepackage{booktabs} and UTF-8.
std::string latex(const TableView& table_view);

/// RFC 4180, with the title as first column and without marks and notes.
std::string csv(const TableView& table_view);

/// Padded with spaces to that width.
std::string padded(const std::string& text, std::size_t columns, bool left);

/// Replaces line breaks, tabs and other control characters by spaces.
std::string one_line(const std::string& text);

/// Width of the widest text of each column, including headings, after `escaped` is applied to text
/// and marks.
std::vector<std::size_t> widths(const std::vector<std::vector<std::string>>& lines);

}  // namespace loopbench::harness
