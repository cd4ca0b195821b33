#include <string_view>

#include "harness/tables/table.hpp"

namespace loopbench::harness {
namespace {

std::string escaped_latex(const std::string& text) {
  std::string out;
  const std::string line = one_line(text);
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    switch (c) {
      case '\\':
        out += "\\textbackslash{}";
        break;
      case '~':
        out += "\\textasciitilde{}";
        break;
      case '^':
        out += "\\textasciicircum{}";
        break;
      case '<':
        out += "\\textless{}";
        break;
      case '>':
        out += "\\textgreater{}";
        break;
      case '|':
        out += "\\textbar{}";
        break;
      case '"':
        out += "\\textquotedbl{}";  // \usepackage[T1]{fontenc}
        break;
      case '[':  // after \\ it would start an optional length
        out += "{[}";
        break;
      case '\xc2':  // of U+00B1, plus-minus
        if (line.compare(i, 2, "\u00b1") == 0) {
          out += "$\\pm$";
          ++i;
        } else {
          out += c;
        }
        break;
      default:
        if (std::string_view("&%$#_{}").find(c) != std::string_view::npos) out += '\\';
        out += c;
    }
  }
  return out;
}

std::string marked_latex(const TableCell& cell) {
  const std::string text = escaped_latex(cell.text);
  if (cell.mark == Mark::best) return "\\textbf{" + text + "}";
  if (cell.mark == Mark::second) return "\\underline{" + text + "}";
  return text;
}

}  // namespace

std::string latex(const Table& all) {
  const Table table = without_empty_columns(all);
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
