#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "harness/answers/tables/latex_text.hpp"
#include "harness/answers/tables/table.hpp"
#include "harness/sweep/text/wrap.hpp"

namespace loopbench::harness {
namespace {

using Columns = std::vector<std::size_t>;

constexpr double kGapBetween = 8.0;   ///< between columns [pt]: twice \tabcolsep
constexpr double kNameShare = 0.4;    ///< of the width, for names that are broken into lines
constexpr double kLeastScale = 0.75;  ///< of a table that does not fit

/// A column with its heading in lines.
struct PaperColumn {
  std::vector<std::string> heading;
  double width = 0.0;  ///< [pt]
};

std::vector<PaperColumn> columns_of(const Table& table, double limit) {
  std::vector<PaperColumn> out;
  for (std::size_t c = 0; c < table.headings.size(); ++c) {
    PaperColumn& column = out.emplace_back();
    std::size_t longest = 9;  // characters; wider headings are broken if entries are narrower
    for (const auto& line : table.lines) {
      longest = std::max(longest, width(line[c].text));
      column.width =
          std::max(column.width, (line[c].is_best ? 1.15 : 1.0) * latex_width(line[c].text));
    }
    column.heading = wrapped(table.headings[c], longest);
    for (const std::string& line : column.heading) {
      column.width = std::max(column.width, latex_width(line));
    }
    if (c == 0) column.width = std::min(column.width, kNameShare * limit);
  }
  return out;
}

/// The columns of each part, which all begin with the names.
std::vector<Columns> parts_of(const std::vector<PaperColumn>& columns, double limit) {
  std::vector<Columns> out{{0}};
  double used = columns[0].width;
  for (std::size_t c = 1; c < columns.size(); ++c) {
    const double more = kGapBetween + columns[c].width;
    if (used + more > limit && out.back().size() > 1) {
      out.push_back({0});
      used = columns[0].width;
    }
    out.back().push_back(c);
    used += more;
  }
  return out;
}

std::string heading_text(const std::vector<std::string>& lines) {
  std::string out;
  for (const std::string& line : lines) out += (out.empty() ? "" : "\\\\") + escaped_latex(line);
  return lines.size() < 2 ? out : "\\shortstack[r]{" + out + "}";
}

/// A tabular, scaled down if it is wider than the line after all.
std::string tabular(const Table& table,
                    const std::vector<PaperColumn>& columns,
                    const Columns& shown,
                    double limit) {
  const bool has_long_names = columns[0].width >= kNameShare * limit;
  const std::string names =
      has_long_names ? fmt::format("p{{{:.0f}pt}}", columns[0].width) : std::string("l");
  std::string out = "\\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{%\n";
  out += "\\begin{tabular}{@{}" + names + std::string(shown.size() - 1, 'r') + "@{}}\n\\toprule\n";
  for (const std::size_t c : shown) out += (c == 0 ? "" : " & ") + heading_text(columns[c].heading);
  out += " \\\\\n\\midrule\n";
  for (const auto& line : table.lines) {
    for (const std::size_t c : shown) {
      const std::string text = c == 0 ? breakable(line[c].text) : escaped_latex(line[c].text);
      if (c > 0) out += " & ";
      if (c == 0 && has_long_names) out += "\\raggedright\\hangindent=1em ";
      out += line[c].is_best ? "\\textbf{" + text + "}" : text;
    }
    out += " \\\\\n";
  }
  return out + "\\bottomrule\n\\end{tabular}}\n";
}

double line_width_of(bool wide) { return wide ? 495.0 : 239.0; }  // [pt]

/// Natural width [pt].
double natural_width(const std::vector<PaperColumn>& columns) {
  double out = -kGapBetween;
  for (const PaperColumn& column : columns) out += kGapBetween + column.width;
  return out;
}

/// Columns become rows, also in the note on what is marked.
Table transposed(const Table& table) {
  Table out = table;
  const std::string unit = table.units.empty() ? "" : table.units[0];
  out.headings = {unit.empty() ? "" : "[" + unit + "]"};
  out.units.clear();
  for (const auto& line : table.lines) out.headings.push_back(line[0].text);
  out.lines.clear();
  for (std::size_t c = 1; c < table.headings.size(); ++c) {
    std::vector<TableCell>& line = out.lines.emplace_back();
    line.emplace_back(table.headings[c]);
    for (const auto& before : table.lines) line.push_back(before[c]);
  }
  if (!table.marks) return out;
  out.marks->is_of_columns = !table.marks->is_of_columns;
  std::ranges::replace(
      out.notes, TableNote(marks_text(*table.marks)), TableNote(marks_text(*out.marks)));
  return out;
}

/// Marks numbers that are printed as a best one of their column (or row) but are not best.
void mark_equal_numbers(Table& table) {
  if (!table.marks) return;
  const bool is_of_columns = table.marks->is_of_columns;
  bool is_marked = false;
  std::vector<std::pair<TableCell*, std::size_t>> best, others;  // with their column or row
  for (std::size_t r = 0; r < table.lines.size(); ++r) {
    for (std::size_t c = 1; c < table.lines[r].size(); ++c) {
      TableCell& cell = table.lines[r][c];
      (cell.is_best ? best : others).emplace_back(&cell, is_of_columns ? c : r);
    }
  }
  for (const auto& [cell, lane] : others) {
    const auto is_equal = [&, text = cell->text, own = lane](const auto& each) {
      return each.second == own && each.first->text == text;
    };
    if (cell->text.empty() || std::ranges::none_of(best, is_equal)) continue;
    cell->text += kDagger;
    is_marked = true;
  }
  if (!is_marked) return;
  const auto about_marks = std::ranges::find(table.notes, TableNote(marks_text(*table.marks)));
  table.notes.insert(
      about_marks == table.notes.end() ? about_marks : about_marks + 1,
      std::string(kDagger) + ": shown to be worse than an equally printed bold number");
}

/// The notes of a paper.
void keep_notes_of_papers(Table& table) {
  for (TableNote& note : table.notes) note = one_line(note.in_paper.value_or(note.text));
  std::erase(table.notes, TableNote());
}

struct PaperLayout {
  Table table;
  bool wide = false;
  std::vector<PaperColumn> columns = {};
  std::vector<Columns> parts = {};
};

/// The first layout that fits, see latex().
PaperLayout layout_of(const Table& table, bool wide) {
  const Table other = transposed(table);
  std::vector<PaperLayout> tries{{table, wide}, {other, wide}};
  if (!wide) tries.insert(tries.end(), {{table, true}, {other, true}});
  for (PaperLayout& each : tries) each.columns = columns_of(each.table, line_width_of(each.wide));
  const auto fits = [](const PaperLayout& each, double scale) {
    return scale * natural_width(each.columns) <= line_width_of(each.wide);
  };
  for (const double scale : {1.0, kLeastScale}) {
    for (PaperLayout& each : tries) {
      if (!fits(each, scale) || (scale < 1.0 && !each.wide)) continue;
      Columns& all = each.parts.emplace_back();
      for (std::size_t c = 0; c < each.columns.size(); ++c) all.push_back(c);
      return each;
    }
  }
  tries[0].parts = parts_of(tries[0].columns, line_width_of(wide));
  return tries[0];
}

}  // namespace

std::string latex(const Table& all, const LatexOptions& options) {
  Table table = with_common_unit(without_empty_columns(all));
  keep_notes_of_papers(table);
  mark_equal_numbers(table);
  const char* const separator = table.title.empty() || table.facts.empty() ? "" : "; ";
  const std::string stated = table.title + separator + table.facts;
  std::erase_if(table.notes,
                [&](const TableNote& note) { return stated.find(note.text) != std::string::npos; });
  if (!options.caption.empty() && !stated.empty()) table.notes.insert(table.notes.begin(), stated);
  std::string comments, cautions;
  for (const std::string& line : table.above) {
    comments += "% note: " + one_line(line) + "\n";
    cautions += (cautions.empty() ? " Note: " : "; ") + breakable(one_line(line));
  }
  const auto notes_of = [](const Table& from) {
    std::string out;
    for (const TableNote& note : from.notes) out += breakable(note.text) + "\\par\n";
    return out;
  };
  if (table.headings.empty()) {
    return comments + "\\noindent " + breakable(table.title) + cautions + "\\par\n" +
           notes_of(table);
  }
  const PaperLayout layout = layout_of(table, options.wide);
  const std::string notes = notes_of(layout.table);
  const std::string environment = layout.wide ? "{table*}" : "{table}";
  const std::string caption = (options.caption.empty() ? breakable(stated) : options.caption) +
                              (cautions.empty() ? "" : "." + cautions);
  std::string out = comments;
  for (std::size_t p = 0; p < layout.parts.size(); ++p) {
    const std::string part =
        layout.parts.size() == 1 ? "" : fmt::format(" (part {} of {})", p + 1, layout.parts.size());
    const std::string label =
        options.label.empty() || p > 0 ? "" : "\\label{" + options.label + "}";
    out += "\\begin" + environment + "\n\\centering\\footnotesize\\setlength{\\tabcolsep}{4pt}\n";
    if (!caption.empty() || !label.empty())
      out += "\\caption{" + caption + part + "}" + label + "\\smallskip\n";
    out += tabular(layout.table, layout.columns, layout.parts[p], line_width_of(layout.wide));
    if (p + 1 == layout.parts.size() && !notes.empty()) {
      out += "\\par\\smallskip\n\\parbox{\\linewidth}{\\raggedright\\scriptsize\n" + notes + "}\n";
    }
    out += "\\end" + environment + "\n";
  }
  return out;
}

}  // namespace loopbench::harness
