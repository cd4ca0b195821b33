#include <algorithm>
#include <cctype>
#include <utility>

#include "harness/answers/tables/table.hpp"
#include "harness/sweep/text/wrap.hpp"

namespace loopbench::harness {
namespace {

/// Escapes `_` only at word boundaries, and `<` and `&` only before a letter or a sign other than
/// `=`, and `]` only where it would make a link or an image, so that names such as
/// uniform_position, p < 0.05 and p <= 0.05 remain readable.
std::string escaped_markdown(const std::string& text) {
  const std::string line = one_line(text);
  const auto is_word = [&](std::size_t i) {
    return i < line.size() && std::isalnum(static_cast<unsigned char>(line[i])) != 0;
  };
  std::string out;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    const bool is_tag =
        i + 1 < line.size() &&
        (is_word(i + 1) || std::ispunct(static_cast<unsigned char>(line[i + 1])) != 0);
    const bool is_link = c == ']' && i + 1 < line.size() && line[i + 1] == '(';
    const bool is_emphasis = c == '_' && !(i > 0 && is_word(i - 1) && is_word(i + 1));
    const bool is_html = is_tag && (c == '&' || (c == '<' && line[i + 1] != '='));
    if (is_emphasis || is_link || is_html || c == '|' || c == '\\' || c == '*' || c == '`') {
      out += '\\';
    }
    out += c;
  }
  return out;
}

std::string marked_markdown(const TableCell& cell) {
  const char* around = cell.is_best ? "**" : "";
  return around + escaped_markdown(cell.text) + around;
}

/// Width of the widest text of each column, at least 3 for the rule.
std::vector<std::size_t> widths(const std::vector<std::vector<std::string>>& grid) {
  std::vector<std::size_t> out(grid[0].size(), 3);
  for (const auto& line : grid) {
    for (std::size_t c = 0; c < line.size(); ++c) out[c] = std::max(out[c], width(line[c]));
  }
  return out;
}

std::string line_of(const std::vector<std::string>& texts, const std::vector<std::size_t>& wide) {
  std::string out = "|";
  for (std::size_t c = 0; c < texts.size(); ++c)
    out += " " + padded(texts[c], wide[c], c == 0) + " |";
  return out + "\n";
}

std::string grid_text(const Table& table) {
  std::vector<std::vector<std::string>> grid(1);
  for (const std::string& heading : table.headings) grid[0].push_back(escaped_markdown(heading));
  for (const auto& line : table.lines) {
    grid.emplace_back();
    for (const TableCell& cell : line) grid.back().push_back(marked_markdown(cell));
  }
  const std::vector<std::size_t> wide = widths(grid);
  std::string out = line_of(grid[0], wide);
  std::vector<std::string> rule;
  for (std::size_t c = 0; c < wide.size(); ++c) {
    rule.push_back(c == 0 ? std::string(wide[c], '-') : std::string(wide[c] - 1, '-') + ":");
  }
  out += line_of(rule, wide);
  for (std::size_t r = 1; r < grid.size(); ++r) out += line_of(grid[r], wide);
  return out;
}

}  // namespace

std::string markdown(const Table& all) {
  const Table table = with_common_unit(without_empty_columns(all));
  std::string out;
  for (const std::string& line : table.above) out += "> " + escaped_markdown(line) + "\n>\n";
  if (!out.empty()) out.replace(out.size() - 2, 2, "\n");  // a quotation ends before the title
  if (!table.title.empty()) out += "### " + escaped_markdown(table.title) + "\n\n";
  if (!table.headings.empty()) out += grid_text(table);
  if (!table.headings.empty() && !table.notes.empty()) out += "\n";
  for (const std::string& note : note_texts(table)) {
    const char* indent = "- ";
    for (const std::string& line : wrapped(escaped_markdown(note), table.note_width)) {
      const bool is_mark = line.starts_with("+ ") || line.starts_with("- ") ||
                           line.starts_with("# ") || line.starts_with(">");
      out += std::exchange(indent, "  ") + std::string(is_mark ? "\\" : "") + line + "\n";
    }
  }
  return out;
}

std::string markdown(const std::vector<Table>& tables) {
  std::string out;
  for (const Table& table : tables) out += (out.empty() ? "" : "\n") + markdown(table);
  return out;
}

}  // namespace loopbench::harness
