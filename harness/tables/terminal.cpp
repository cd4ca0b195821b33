#include "harness/tables/table_view.hpp"

namespace loopbench::harness {

std::string terminal(const TableView& table_view) {
  std::vector<std::vector<std::string>> grid(1);
  for (const std::string& heading : table_view.headings) grid[0].push_back(one_line(heading));
  for (const auto& line : table_view.lines) {
    grid.emplace_back();
    for (const TableViewEntry& entry : line) {
      grid.back().push_back(one_line(entry.text) + (entry.mark == Mark::best     ? "*"
                                                    : entry.mark == Mark::second ? "+"
                                                                                 : ""));
    }
  }
  // The mark has its own column, so that digits are aligned.
  for (std::size_t c = 1; c < table_view.headings.size(); ++c) {
    bool has_mark = false;
    for (const auto& line : table_view.lines) has_mark = has_mark || line[c].mark != Mark::none;
    if (!has_mark) continue;
    grid[0][c] += " ";
    for (std::size_t r = 0; r < table_view.lines.size(); ++r) {
      if (table_view.lines[r][c].mark == Mark::none) grid[r + 1][c] += " ";
    }
  }
  const std::vector<std::size_t> wide = widths(grid);
  std::string out = table_view.title.empty() ? "" : one_line(table_view.title) + "\n";
  const auto trimmed = [](std::string line) {
    line.erase(line.find_last_not_of(' ') + 1);
    return line + "\n";
  };
  for (std::size_t r = 0; r < grid.size(); ++r) {
    std::string line;
    for (std::size_t c = 0; c < grid[r].size(); ++c) {
      line += (c == 0 ? "" : "  ") + padded(grid[r][c], wide[c], c == 0);
    }
    out += trimmed(line);
    if (r > 0) continue;
    std::string rule;
    for (std::size_t c = 0; c < wide.size(); ++c) {
      rule += (c == 0 ? "" : "  ") + std::string(wide[c], '-');
    }
    out += rule + "\n";
  }
  for (const std::string& note : table_view.notes) out += one_line(note) + "\n";
  return out;
}

}  // namespace loopbench::harness
