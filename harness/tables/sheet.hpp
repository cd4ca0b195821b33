/// A table as it is shown: text only, the same for every format that people read.
#pragma once

#include <string>
#include <vector>

#include "harness/tables/mark_best.hpp"
#include "harness/tables/pivot.hpp"

namespace loopbench {

struct SheetEntry {
  std::string text;
  Mark mark = Mark::none;
};

/// The first column names the rows and stands left, the others are numbers and stand right.
struct Sheet {
  std::string title;
  std::vector<std::string> headings;
  std::vector<std::vector<SheetEntry>> lines;  ///< [row][column]
  std::vector<std::string> notes;              ///< one a line, below
};

/// A number with the decimals its column needs: four significant ones for the largest.
int decimals(double largest);

/// `value` with that many decimals; never -0.00, which says nothing.
std::string fixed(double value, int digits);

/// A table's numbers with the decimals that each column needs.
Sheet sheet(const Table& table);

/// GitHub Markdown with padded columns, so that it reads on a terminal too. Best bold, second best
/// in italics. Whatever Markdown or HTML would take for markup is escaped.
std::string markdown(const Sheet& sheet);

/// Aligned columns without markup: `*` behind the best, `+` behind the second best.
std::string terminal(const Sheet& sheet);

/// A booktabs tabular with its caption and notes as comments around it. Best bold, second best
/// underlined. Escaped; needs \usepackage{booktabs} and UTF-8.
std::string latex(const Sheet& sheet);

/// Columns on a terminal: code points, not bytes.
std::size_t width(const std::string& text);

/// Filled up with spaces to that width.
std::string padded(const std::string& text, std::size_t columns, bool left);

/// Line breaks, tabs and other control characters as spaces: a name never leaves its cell.
std::string one_line(const std::string& text);

/// The widest text of each column, headings included, once `escaped` has been applied to the text
/// and marks.
std::vector<std::size_t> widths(const std::vector<std::vector<std::string>>& lines);

}  // namespace loopbench
