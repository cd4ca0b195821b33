#include "harness/tables/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "datasets/core/error.hpp"
#include "harness/base/printable.hpp"
#include "harness/base/suggest.hpp"
#include "harness/base/wrap.hpp"
#include "metrics/correction/optimality.hpp"

namespace loopbench::harness {
namespace {

/// "rpe 1 s [m]" and "rpe_1_s" name the column "rpe 1 s [m]".
bool is_column_name(const std::string& heading, const std::string& name) {
  const auto plain = [](std::string text) {
    std::ranges::replace(text, '_', ' ');
    return text;
  };
  return plain(name) == plain(heading) ||
         plain(name) == plain(heading.substr(0, heading.rfind(" [")));
}

std::string mean_text(const TableMean& mean, int digits) {
  const std::string over =
      mean.possible == 0 ? "" : fmt::format(" ({} of {})", mean.records, mean.possible);
  const std::string deviation = mean.deviation ? " \u00b1 " + fixed(*mean.deviation, digits) : "";
  const std::string stated = mean.is_stated ? " (s)" : "";
  if (mean.value && mean.is_gap) return metrics::gap_text(*mean.value) + over;
  if (mean.value) return fixed(*mean.value, digits) + deviation + stated + over;
  if (mean.status == kNoCommonRun) return "-" + over;
  return mean.status.empty() ? "-" : mean.status;
}

/// Decimals of a column; none if all its values are integers.
int column_digits(const Table& table, std::size_t column) {
  double largest = 0.0;
  bool all_integers = true;
  for (const auto& line : table.lines) {
    if (!line[column].mean) continue;
    const double value = line[column].mean->value.value_or(0.0);
    largest = std::max(largest, std::abs(value));
    all_integers = all_integers && value == std::round(value);
  }
  return all_integers && largest > 0.0 ? 0 : decimals(largest);
}

/// Whether the mean says more than that there is no value.
bool has_content(const TableMean& mean) {
  return mean.value || (!mean.status.empty() && mean.status != "undefined" &&
                        mean.status != "declined" && mean.status != kNoCommonRun);
}

}  // namespace

int decimals(double largest) {
  if (!(largest > 0.0) || !std::isfinite(largest)) return 4;
  const int whole_digits = static_cast<int>(std::floor(std::log10(largest))) + 1;
  constexpr double kRounding = 1e-7;  // values below are rounding errors
  if (largest < 1e-3 && largest > kRounding) return 3 - whole_digits;
  return std::clamp(4 - whole_digits, 1, 4);
}

std::string fixed(double value, int digits) {
  const std::string text = fmt::format("{:.{}f}", value, digits);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text[0] == '-' ? text.substr(1) : text;
}

void format_means(Table& table) {
  for (std::size_t c = 1; c < table.headings.size(); ++c) {
    const int digits = column_digits(table, c);
    for (auto& line : table.lines) {
      if (line[c].mean) line[c].text = mean_text(*line[c].mean, digits);
    }
  }
}

Table without_empty_columns(Table table) {
  std::vector<std::size_t> kept;
  bool has_means = false;
  for (std::size_t c = 0; c < table.headings.size(); ++c) {
    const bool is_of_texts = std::ranges::none_of(
        table.lines, [&](const auto& line) { return line[c].mean.has_value(); });
    const bool is_filled = std::ranges::any_of(
        table.lines, [&](const auto& line) { return line[c].mean && has_content(*line[c].mean); });
    has_means = has_means || is_filled;
    if (is_of_texts || is_filled) kept.push_back(c);
  }
  if (!has_means || kept.size() == table.headings.size()) return table;
  const auto keep = [&](auto& list) {
    std::remove_reference_t<decltype(list)> out;
    for (const std::size_t c : kept) out.push_back(std::move(list[c]));
    list = std::move(out);
  };
  keep(table.headings);
  for (auto& line : table.lines) keep(line);
  return table;
}

Table with_common_unit(Table table) {
  const std::vector<std::string>& headings = table.headings;
  if (headings.size() < 3) return table;
  const std::size_t begin = std::min(headings[1].rfind(" ["), headings[1].size());
  const std::string unit = headings[1].substr(begin);
  const auto has_unit = [&](const std::string& heading) { return heading.ends_with(unit); };
  if (unit.empty() || !std::all_of(headings.begin() + 1, headings.end(), has_unit)) return table;
  for (std::size_t c = 1; c < headings.size(); ++c) {
    table.headings[c].resize(headings[c].size() - unit.size());
  }
  (table.title.empty() ? table.headings[0] : table.title) += unit;
  return table;
}

std::vector<Table> with_columns(std::vector<Table> tables, const std::vector<std::string>& names) {
  if (names.empty()) return tables;
  std::vector<std::string> known;
  for (const Table& table : tables) {
    for (std::size_t c = 1; c < table.headings.size(); ++c) {
      const bool is_new = std::ranges::count(known, table.headings[c]) == 0;
      if (is_new) known.push_back(table.headings[c]);
    }
  }
  if (known.empty()) return tables;  // nothing was evaluated
  for (const std::string& name : names) {
    const auto is_named = [&](const std::string& heading) { return is_column_name(heading, name); };
    if (std::ranges::any_of(known, is_named)) continue;
    std::vector<std::string> plain;  // without units
    for (const std::string& heading : known) {
      const std::string each = heading.substr(0, heading.rfind(" ["));
      if (std::ranges::count(plain, each) == 0) plain.push_back(each);
    }
    throw InputError("--columns: " + unknown_name("column", name, plain));
  }
  for (Table& table : tables) {
    std::vector<std::size_t> places{0};
    for (const std::string& name : names) {
      for (std::size_t c = 1; c < table.headings.size(); ++c) {
        const bool is_named = is_column_name(table.headings[c], name);
        if (is_named && std::ranges::count(places, c) == 0) places.push_back(c);
      }
    }
    const auto chosen = [&](const auto& all) {
      std::decay_t<decltype(all)> out;
      for (const std::size_t place : places) out.push_back(all[place]);
      return out;
    };
    table.headings = chosen(table.headings);
    for (std::vector<TableCell>& line : table.lines) line = chosen(line);
  }
  return tables;
}

std::string padded(const std::string& text, std::size_t columns, bool left) {
  const std::string gap(columns - std::min(columns, width(text)), ' ');
  return left ? text + gap : gap + text;
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return printable(text);
}

}  // namespace loopbench::harness
