#include <cctype>

#include "harness/tables/text.hpp"

namespace loopbench::harness {
namespace {

/// Escapes `_` only at word boundaries, and `<` and `&` only before a letter or a sign other than
/// `=`, so that names such as uniform_position, p < 0.05 and p <= 0.05 remain readable.
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
    const bool is_emphasis = c == '_' && !(i > 0 && is_word(i - 1) && is_word(i + 1));
    if (c == '<' && is_tag && line[i + 1] != '=') {
      out += "&lt;";
    } else if (c == '&' && is_tag) {
      out += "&amp;";
    } else {
      if (is_emphasis || c == '|' || c == '\\' || c == '*' || c == '`') out += '\\';
      out += c;
    }
  }
  return out;
}

std::string marked_markdown(const TableViewEntry& entry) {
  const char* around = entry.mark == Mark::best ? "**" : entry.mark == Mark::second ? "_" : "";
  return around + escaped_markdown(entry.text) + around;
}

std::string line_of(const std::vector<std::string>& texts, const std::vector<std::size_t>& wide) {
  std::string out = "|";
  for (std::size_t c = 0; c < texts.size(); ++c)
    out += " " + padded(texts[c], wide[c], c == 0) + " |";
  return out + "\n";
}

}  // namespace

std::string markdown(const TableView& table_view) {
  std::vector<std::vector<std::string>> grid(1);
  for (const std::string& heading : table_view.headings)
    grid[0].push_back(escaped_markdown(heading));
  for (const auto& line : table_view.lines) {
    grid.emplace_back();
    for (const TableViewEntry& entry : line) grid.back().push_back(marked_markdown(entry));
  }
  const std::vector<std::size_t> wide = widths(grid);
  std::string out =
      table_view.title.empty() ? "" : "### " + escaped_markdown(table_view.title) + "\n\n";
  out += line_of(grid[0], wide);
  std::vector<std::string> rule;
  for (std::size_t c = 0; c < wide.size(); ++c) {
    rule.push_back(c == 0 ? std::string(wide[c], '-') : std::string(wide[c] - 1, '-') + ":");
  }
  out += line_of(rule, wide);
  for (std::size_t r = 1; r < grid.size(); ++r) out += line_of(grid[r], wide);
  if (!table_view.notes.empty()) out += "\n";
  for (const std::string& note : table_view.notes) out += "- " + escaped_markdown(note) + "\n";
  return out;
}

std::string markdown(const Table& table) { return markdown(table_view(table)); }

std::string markdown(const std::vector<Table>& tables) {
  std::string out;
  for (const Table& table : tables) out += (out.empty() ? "" : "\n") + markdown(table);
  return out;
}

}  // namespace loopbench::harness
