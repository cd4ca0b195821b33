#include "harness/tables/table_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/base/printable.hpp"
#include "harness/base/wrap.hpp"

namespace loopbench::harness {
namespace {

std::string shown(const TableEntry& entry, int digits) {
  const std::string over =
      entry.possible == 0 ? "" : fmt::format(" ({} of {})", entry.records, entry.possible);
  const std::string deviation = entry.deviation ? " \u00b1 " + fixed(*entry.deviation, digits) : "";
  if (entry.value) return fixed(*entry.value, digits) + deviation + over;
  if (entry.status == kNoCommonRun) return "-" + over;
  return entry.status.empty() ? "-" : entry.status;
}

int digits_of(const Table& table, std::size_t column) {
  double largest = 0.0;
  bool all_integers = true;
  for (const auto& row : table.entries) {
    const double value = row[column].value.value_or(0.0);
    largest = std::max(largest, std::abs(value));
    all_integers = all_integers && value == std::round(value);
  }
  return all_integers && largest > 0.0 ? 0 : decimals(largest);
}

/// Whether the entry says more than that there is no value.
bool has_content(const TableEntry& entry) {
  return entry.value || (!entry.status.empty() && entry.status != "undefined" &&
                         entry.status != "declined" && entry.status != kNoCommonRun);
}

/// Columns with values or failures; all columns if there are none.
std::vector<std::size_t> columns_with_values(const Table& table) {
  std::vector<std::size_t> out;
  std::vector<std::size_t> all;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    all.push_back(c);
    const auto is_filled = [&](const auto& row) { return has_content(row[c]); };
    if (std::ranges::any_of(table.entries, is_filled)) out.push_back(c);
  }
  return out.empty() ? all : out;
}

}  // namespace

int decimals(double largest) {
  if (!(largest > 0.0) || !std::isfinite(largest)) return 4;
  const int whole_digits = static_cast<int>(std::floor(std::log10(largest))) + 1;
  return std::clamp(4 - whole_digits, 1, 4);
}

std::string fixed(double value, int digits) {
  const std::string text = fmt::format("{:.{}f}", value, digits);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text[0] == '-' ? text.substr(1) : text;
}

TableView table_view(const Table& table) {
  TableView out{table.title, {table.corner}, {}, table.notes};
  for (const std::string& row : table.rows) out.lines.push_back({{row, Mark::none}});
  for (const std::size_t c : columns_with_values(table)) {
    out.headings.push_back(table.columns[c]);
    const int digits = digits_of(table, c);
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      const TableEntry& entry = table.entries[r][c];
      out.lines[r].push_back({shown(entry, digits), entry.mark});
    }
  }
  return out;
}

std::string padded(const std::string& text, std::size_t columns, bool left) {
  const std::string gap(columns - std::min(columns, width(text)), ' ');
  return left ? text + gap : gap + text;
}

std::string one_line(const std::string& text) {
  std::string out = text;
  for (char& c : out) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return printable(out);
}

std::vector<std::size_t> widths(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> out;
  for (const auto& line : lines) {
    out.resize(std::max(out.size(), line.size()), 3);
    for (std::size_t c = 0; c < line.size(); ++c) out[c] = std::max(out[c], width(line[c]));
  }
  return out;
}

}  // namespace loopbench::harness
