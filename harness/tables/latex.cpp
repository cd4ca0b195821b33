#include <map>

#include "harness/tables/table.hpp"

namespace loopbench::harness {
namespace {

std::string escaped_latex(const std::string& text) {
  static const std::map<char, std::string> kEscaped{
      {'\\', "\\textbackslash{}"},
      {'~', "\\textasciitilde{}"},
      {'^', "\\textasciicircum{}"},
      {'<', "\\textless{}"},
      {'>', "\\textgreater{}"},
      {'|', "\\textbar{}"},
      {'"', "\\textquotedbl{}"},  // needs T1 fonts
      {'[', "{[}"},               // else a length after a line break
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

std::string marked_latex(const TableCell& cell) {
  const std::string text = escaped_latex(cell.text);
  return cell.is_best ? "\\textbf{" + text + "}" : text;
}

}  // namespace

std::string latex(const Table& all) {
  const Table table = with_common_unit(without_empty_columns(all));
  const bool has_caption = !table.title.empty();
  std::string out =
      has_caption ? "\\begin{table}\n\\centering\n\\caption{" + escaped_latex(table.title) + "}\n"
                  : "";
  out += "\\begin{tabular}{l" + std::string(table.headings.size() - 1, 'r') + "}\n\\toprule\n";
  for (std::size_t c = 0; c < table.headings.size(); ++c) {
    out += (c == 0 ? "" : " & ") + escaped_latex(table.headings[c]);
  }
  out += " \\\\\n\\midrule\n";
  for (const auto& line : table.lines) {
    for (std::size_t c = 0; c < line.size(); ++c)
      out += (c == 0 ? "" : " & ") + marked_latex(line[c]);
    out += " \\\\\n";
  }
  out += "\\bottomrule\n\\end{tabular}\n";
  if (has_caption) out += "\\end{table}\n";
  for (const std::string& note : table.notes) out += "% " + one_line(note) + "\n";
  return out;
}

}  // namespace loopbench::harness
