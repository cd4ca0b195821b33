#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <string_view>

#include "harness/answers/tables/table.hpp"
#include "harness/sweep/text/wrap.hpp"

namespace loopbench::harness {
namespace {

using Columns = std::vector<std::size_t>;

constexpr double kGapBetween = 8.0;  ///< between columns [pt]: twice \tabcolsep
constexpr double kNameShare = 0.4;   ///< of the width, for names that are broken into lines

std::string escaped_latex(const std::string& text) {
  static const std::map<char, std::string> kEscaped{
      {'\\', "\\textbackslash{}"},
      {'~', "\\textasciitilde{}"},
      {'^', "\\textasciicircum{}"},
      {'<', "\\textless{}"},
      {'>', "\\textgreater{}"},
      {'|', "\\textbar{}"},
      {'"', "\\char34{}"},
      {'[', "{[}"},  // else a length after a line break
      {'-', "{-}"},  // else -- is a dash
      {'&', "\\&"},
      {'%', "\\%"},
      {'$', "\\$"},
      {'#', "\\#"},
      {'_', "\\_"},
      {'{', "\\{"},
      {'}', "\\}"}};
  std::string out;
  for (const char c : one_line(text)) {
    const auto found = kEscaped.find(c);
    out += found == kEscaped.end() ? std::string(1, c) : found->second;
  }
  const std::string plus_minus = "\u00b1";
  for (std::size_t at = 0; (at = out.find(plus_minus, at)) != std::string::npos;) {
    out.replace(at, plus_minus.size(), "$\\pm$");
  }
  return out;
}

/// In a paragraph, names and paths can be broken after these characters.
std::string breakable(const std::string& text) {
  std::string out, part;
  for (std::size_t i = 0; i < text.size(); ++i) {
    part += text[i];
    const bool is_break = std::string_view("_/=").find(text[i]) != std::string_view::npos;
    if (!is_break && i + 1 < text.size()) continue;
    out += escaped_latex(part) + (is_break ? "\\allowbreak{}" : "");
    part.clear();
  }
  return out;
}

/// Width in Computer Modern of 8 pt, rounded up [pt].
double points(const std::string& text) {
  static constexpr std::pair<std::string_view, double> kWidths[] = {
      {"ijl.,:;'!|", 2.4},
      {"rtfs()[]- ", 3.4},
      {"0123456789", 4.3},
      {"mwMW%+=<>@\xc2", 7.1},
      {"ABCDEFGHIJKLNOPQRSTUVXYZ", 6.4}};
  double out = 0.0;
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) & 0xc0) == 0x80) continue;  // continues a character
    const auto found = std::ranges::find_if(
        kWidths, [c](const auto& each) { return each.first.find(c) != std::string_view::npos; });
    out += found == std::end(kWidths) ? 4.8 : found->second;
  }
  return out;
}

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
      column.width = std::max(column.width, (line[c].is_best ? 1.15 : 1.0) * points(line[c].text));
    }
    column.heading = wrapped(table.headings[c], longest);
    for (const std::string& line : column.heading) {
      column.width = std::max(column.width, points(line));
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

}  // namespace

std::string latex(const Table& all, bool wide) {
  const Table table = with_common_unit(without_empty_columns(all));
  std::string notes;
  for (const std::string& note : table.notes) notes += breakable(one_line(note)) + "\\par\n";
  std::string comments, cautions;
  for (const std::string& line : table.above) {
    comments += "% note: " + one_line(line) + "\n";
    cautions += (cautions.empty() ? " Note: " : "; ") + breakable(one_line(line));
  }
  if (table.headings.empty())
    return comments + "\\noindent " + breakable(table.title) + cautions + "\\par\n" + notes;
  const double limit = wide ? 495.0 : 239.0;  // [pt]
  const std::vector<PaperColumn> columns = columns_of(table, limit);
  const std::vector<Columns> parts = parts_of(columns, limit);
  const std::string environment = wide ? "{table*}" : "{table}";
  const char* const separator = table.title.empty() || table.facts.empty() ? "" : "; ";
  const std::string caption =
      breakable(table.title + separator + table.facts) + (cautions.empty() ? "" : "." + cautions);
  std::string out = comments;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const std::string part =
        parts.size() == 1 ? "" : fmt::format(" (part {} of {})", p + 1, parts.size());
    out += "\\begin" + environment + "\n\\centering\\footnotesize\\setlength{\\tabcolsep}{4pt}\n";
    if (!caption.empty()) out += "\\caption{" + caption + part + "}\\smallskip\n";
    out += tabular(table, columns, parts[p], limit);
    if (p + 1 == parts.size() && !notes.empty()) {
      out += "\\par\\smallskip\n\\parbox{\\linewidth}{\\raggedright\\scriptsize\n" + notes + "}\n";
    }
    out += "\\end" + environment + "\n";
  }
  return out;
}

}  // namespace loopbench::harness
