/// The table that every command prints, and its formats.
#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace loopbench::harness {

/// A text, or a mean and its text. If several methods finished different runs, the mean is over the
/// runs that all of them finished.
struct TableCell {
  TableCell() = default;
  template <std::convertible_to<std::string> Text>
  TableCell(const Text& own_text, bool marked = false) : text(own_text), is_best(marked) {}

  std::string text;
  bool is_best = false;  ///< marked: its method is best in its column or row, see table_numbers.hpp
  bool has_mean = false;  ///< the next members are those of a mean
  std::optional<double> value = {};
  std::optional<double> deviation = {};  ///< see Averages, if requested
  double effective = 0.0;                ///< values of equal weight with as certain a mean
  std::size_t records = 0;               ///< records with a number (repeats, for example)
  std::size_t averaged = 0;  ///< of these, those on runs that all compared cells finished
  std::size_t possible = 0;  ///< records including failed and missing ones; 0: none is missing
  bool is_stated = false;    ///< times that programs state, marked (s)
  bool is_gap = false;       ///< of the metric optimality, printed in words
  std::string status = {};   ///< "declined", "failed", "no common run", ... if there is no value

  friend bool operator==(const TableCell&, const TableCell&) = default;
};

/// What is_best of cells is about: each column, or each row.
struct BestMarks {
  bool is_of_columns = true;
  std::size_t tested = 1;  ///< columns (or rows) that the test is corrected for
};

/// The note about them: "marked: shown to be better than each other method of the column".
std::string marks_text(const BestMarks& marks);

/// What the deviations of cells are: of the values, or halves of the 95 % intervals of the means.
enum class Deviation { none, standard, half_interval };

/// How the means of a table were averaged.
struct Averages {
  std::size_t most = 1;    ///< cells of a mean
  bool is_uneven = false;  ///< sequences have different numbers of cells, and count once each
  Deviation deviation = Deviation::none;
  bool has_gain = false;
  bool has_change = false;
};

/// The note about them: "each number is the mean of up to 6 cells".
std::string averages_text(const Averages& averages);

/// A line below a table.
struct TableNote {
  TableNote() = default;
  template <std::convertible_to<std::string> Text>
  TableNote(const Text& own_text) : text(own_text) {}  // NOLINT(google-explicit-constructor)
  TableNote(std::string own_text, std::string paper)
      : text(std::move(own_text)), in_paper(std::move(paper)) {}

  std::string text;
  /// Instead of `text` in papers, which have no command line: without options; "": left out.
  std::optional<std::string> in_paper = {};

  friend bool operator==(const TableNote&, const TableNote&) = default;
};

/// The first column has the row names and is left-aligned; the others are right-aligned.
struct Table {
  std::string title;
  std::vector<std::string> headings;          ///< with units, as " [m]"
  std::vector<std::vector<TableCell>> lines;  ///< [row][column]
  std::vector<TableNote> notes;               ///< one per line, below the table
  std::vector<std::string> above = {};        ///< what can change a conclusion, above the title
  std::string facts = {};  ///< for captions of papers: statistic, times, alignment, number of runs
  std::size_t note_width = 0;             ///< of the notes in Markdown; 0: one line each
  bool has_scores = true;                 ///< false: all its cells are without a score
  std::vector<std::string> units = {};    ///< of the columns; empty: no common unit
  std::optional<BestMarks> marks = {};    ///< of the note about them
  std::optional<Averages> averages = {};  ///< likewise
};

/// The texts of its notes, for all formats but papers.
std::vector<std::string> note_texts(const Table& table);

/// Properties of the terminal that a table is printed on.
struct TerminalStyle {
  std::size_t width = 0;  ///< in characters; 0: unlimited
  bool color = false;     ///< whether escape sequences for bold and colour are allowed
};

/// Status of a cell without a run that all cells compared with it have finished.
inline constexpr const char* kNoCommonRun = "no common run";

/// Number of decimals of a column: four significant digits for its largest value, at most four
/// decimals, but three significant digits below 0.001.
int decimals(double largest);

/// `value` with that many decimals; -0.00 is printed as 0.00.
std::string fixed(double value, int digits);

/// Sets the texts of the cells that have a mean: the numbers with the decimals of each column,
/// their standard deviation if known, and the number of runs if some are missing.
void format_means(Table& table);

/// Without the columns of means that have no value, if others have: the notes contain the reasons.
/// The formats for reading leave them out.
Table without_empty_columns(Table table);

/// " [m]", with which the heading of a column ends; empty without a unit.
std::string unit_suffix(const std::string& unit);

/// With a unit that all of at least two columns share in the title, or in the first heading if
/// there is no title, instead of in every heading.
Table with_common_unit(Table table);

/// GitHub Markdown, padded for reading on a terminal. Best in bold.
/// Markdown and HTML markup is escaped.
std::string markdown(const Table& table);
std::string markdown(const std::vector<Table>& tables);

/// Aligned columns without markup: `*` after the best. If the table is
/// wider than the terminal, headings are broken into lines, row names shortened, and the columns
/// distributed over several blocks that each repeat the row names. Notes are wrapped.
std::string terminal(const Table& table, const TerminalStyle& style = {});

/// Of a table in a paper.
struct LatexOptions {
  bool wide = false;         ///< as wide as the text (174 mm) instead of one column (84 mm)
  std::string caption = {};  ///< LaTeX; empty: title and facts, which are notes otherwise
  std::string label = {};    ///< for \ref; empty: none
};

/// A float with a caption and the notes below, as TableNote::in_paper has them. A table that is too
/// wide is transposed, or else as wide as the text, or else both; the first that fits. If none
/// does, it is scaled down to at least three quarters, or divided into several parts that each
/// repeat the row names. Best in bold; numbers that are printed equal to a best one of their column
/// or row, but are shown to be worse, have a dagger. Escaped; needs \usepackage{booktabs,graphicx}
/// and UTF-8.
std::string latex(const Table& table, const LatexOptions& options = {});

/// The means, one line each (RFC 4180), in full precision, or the texts of cells without one;
/// `mark` has the words best and stated (a time that programs state), or is empty.
std::string csv(const std::vector<Table>& tables);

/// Array of {title, row_names, columns, rows, notes, above, cells[row][column] {value, records,
/// averaged, deviation, possible, status, mark}}: the means; value is null unless status is ok, and
/// the text of a cell without a mean.
std::string json(const std::vector<Table>& tables);

/// Padded with spaces to that width.
std::string padded(const std::string& text, std::size_t columns, bool left);

/// Replaces line breaks, tabs and other control characters by spaces.
std::string one_line(std::string text);

}  // namespace loopbench::harness
