#include "harness/answers/tables/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "harness/answers/compare/stated.hpp"
#include "harness/sweep/text/counted.hpp"
#include "harness/sweep/text/printable.hpp"
#include "harness/sweep/text/wrap.hpp"
#include "metrics/correction/optimality.hpp"

namespace loopbench::harness {
namespace {

std::string mean_text(const TableCell& mean, int digits) {
  const std::string over =
      mean.possible == 0 ? "" : fmt::format(" ({} of {})", mean.records, mean.possible);
  const std::string deviation = mean.deviation ? " \u00b1 " + fixed(*mean.deviation, digits) : "";
  const std::string stated = mean.is_stated ? kStatedMark : "";
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
    if (!line[column].has_mean) continue;
    const double value = line[column].value.value_or(0.0);
    largest = std::max(largest, std::abs(value));
    all_integers = all_integers && value == std::round(value);
  }
  return all_integers && largest > 0.0 ? 0 : decimals(largest);
}

/// Whether it has a mean that says more than that there is no value.
bool has_content(const TableCell& cell) {
  return cell.value || (!cell.status.empty() && cell.status != "undefined" &&
                        cell.status != "declined" && cell.status != kNoCommonRun);
}

}  // namespace

std::string averages_text(const Averages& averages) {
  std::string out = fmt::format("each number is the mean of up to {} cells", averages.most);
  if (averages.is_uneven) out += ", in which each sequence counts once";
  if (averages.deviation == Deviation::standard) out += ", \u00b1 their standard deviation";
  if (averages.deviation == Deviation::half_interval)
    out += ", \u00b1 half of the 95 % interval of the mean (Student)";
  if (averages.has_gain) out += "; gain is 1 - the geometric mean ratio to the baseline";
  if (averages.has_change) out += "; change is the geometric mean ratio to the baseline - 1";
  return out;
}

std::string marks_text(const BestMarks& marks) {
  const std::string lane = marks.is_of_columns ? "column" : "row";
  return "marked: shown to be better than each other method of the " + lane +
         (marks.tested == 1 ? "" : ", corrected for " + counted(marks.tested, lane));
}

std::string unit_suffix(const std::string& unit) { return unit.empty() ? "" : " [" + unit + "]"; }

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
      if (line[c].has_mean) line[c].text = mean_text(line[c], digits);
    }
  }
}

Table without_empty_columns(Table table) {
  std::vector<std::size_t> kept;
  bool has_means = false;
  for (std::size_t c = 0; c < table.headings.size(); ++c) {
    const bool is_of_texts =
        std::ranges::none_of(table.lines, [&](const auto& line) { return line[c].has_mean; });
    const bool is_filled =
        std::ranges::any_of(table.lines, [&](const auto& line) { return has_content(line[c]); });
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
  if (!table.units.empty()) keep(table.units);
  for (auto& line : table.lines) keep(line);
  return table;
}

Table with_common_unit(Table table) {
  if (table.units.size() < 3) return table;
  const std::string unit = table.units[1];
  const auto is_other = [&](const std::string& each) { return each != unit; };
  if (unit.empty() || std::any_of(table.units.begin() + 1, table.units.end(), is_other))
    return table;
  const std::string text = unit_suffix(unit);
  for (std::size_t c = 1; c < table.headings.size(); ++c) {
    table.headings[c].resize(table.headings[c].size() - text.size());
    table.units[c].clear();
  }
  if (table.title.empty()) {
    table.headings[0] += text;
    table.units[0] = unit;
  } else {
    table.title += text;
  }
  return table;
}

std::string padded(const std::string& text, std::size_t columns, bool left) {
  const std::string gap(columns - std::min(columns, width(text)), ' ');
  return left ? text + gap : gap + text;
}

std::vector<std::string> note_texts(const Table& table) {
  std::vector<std::string> out;
  for (const TableNote& note : table.notes) out.push_back(note.text);
  return out;
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return printable(text);
}

}  // namespace loopbench::harness
