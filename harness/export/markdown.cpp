#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/export/text.hpp"

namespace loopbench {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out;
}

/// Columns on a terminal: code points, not bytes.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t columns, bool left) {
  const std::string gap(columns - std::min(columns, width(text)), ' ');
  return left ? text + gap : gap + text;
}

std::string shown(const TableCell& cell, int digits) {
  if (cell.value) {
    const std::string text = fmt::format("{:.{}f}", *cell.value, digits);
    const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
    return is_zero && text[0] == '-' ? text.substr(1) : text;  // -0.00 says nothing
  }
  return cell.status.empty() ? "-" : cell.status;
}

}  // namespace

int decimals(double largest) {
  if (!(largest > 0.0) || !std::isfinite(largest)) return 4;
  const int whole_digits = static_cast<int>(std::floor(std::log10(largest))) + 1;
  return std::clamp(4 - whole_digits, 1, 4);
}

std::string markdown(const Table& table) {
  std::vector<std::vector<std::string>> grid;  // by column, heading first
  grid.push_back({escaped(table.corner)});
  for (const std::string& row : table.rows) grid.back().push_back(escaped(row));
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    double largest = 0.0;
    bool all_whole = true;
    for (const auto& row : table.cells) {
      const double value = row[c].value.value_or(0.0);
      largest = std::max(largest, std::abs(value));
      all_whole = all_whole && value == std::round(value);
    }
    const int digits = all_whole && largest > 0.0 ? 0 : decimals(largest);
    grid.push_back({escaped(table.columns[c])});
    for (const auto& row : table.cells) grid.back().push_back(shown(row[c], digits));
  }
  std::vector<std::size_t> widths;
  for (const auto& column : grid) {
    std::size_t widest = 3;
    for (const std::string& text : column) widest = std::max(widest, width(text));
    widths.push_back(widest);
  }

  std::string out = table.title.empty() ? "" : "### " + escaped(table.title) + "\n\n";
  for (std::size_t line = 0; line <= table.rows.size(); ++line) {
    out += "|";
    for (std::size_t c = 0; c < grid.size(); ++c) {
      out += " " + padded(grid[c][line], widths[c], c == 0) + " |";
    }
    out += "\n";
    if (line > 0) continue;
    out += "|";
    for (std::size_t c = 0; c < grid.size(); ++c) {
      out += c == 0 ? " " + std::string(widths[c], '-') + " |"
                    : " " + std::string(widths[c] - 1, '-') + ": |";
    }
    out += "\n";
  }
  if (!table.notes.empty()) out += "\n";
  for (const std::string& note : table.notes) out += "- " + escaped(note) + "\n";
  return out;
}

std::string markdown(const std::vector<Table>& tables) {
  std::string out;
  for (const Table& table : tables) out += (out.empty() ? "" : "\n") + markdown(table);
  return out;
}

}  // namespace loopbench
