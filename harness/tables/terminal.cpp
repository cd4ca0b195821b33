#include "harness/tables/sheet.hpp"

namespace loopbench::harness {

std::string terminal(const Sheet& sheet) {
  std::vector<std::vector<std::string>> grid(1);
  for (const std::string& heading : sheet.headings) grid[0].push_back(one_line(heading));
  for (const auto& line : sheet.lines) {
    grid.emplace_back();
    for (const SheetEntry& entry : line) {
      grid.back().push_back(one_line(entry.text) + (entry.mark == Mark::best     ? "*"
                                                    : entry.mark == Mark::second ? "+"
                                                                                 : ""));
    }
  }
  // The mark has its own column, so that digits are aligned.
  for (std::size_t c = 1; c < sheet.headings.size(); ++c) {
    bool has_mark = false;
    for (const auto& line : sheet.lines) has_mark = has_mark || line[c].mark != Mark::none;
    if (!has_mark) continue;
    grid[0][c] += " ";
    for (std::size_t r = 0; r < sheet.lines.size(); ++r) {
      if (sheet.lines[r][c].mark == Mark::none) grid[r + 1][c] += " ";
    }
  }
  const std::vector<std::size_t> wide = widths(grid);
  std::string out = sheet.title.empty() ? "" : one_line(sheet.title) + "\n";
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
  for (const std::string& note : sheet.notes) out += one_line(note) + "\n";
  return out;
}

}  // namespace loopbench::harness
