#include "harness/answers/tables/record_csv.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <type_traits>

#include "harness/sweep/model/cell_fields.hpp"
#include "harness/sweep/text/printable.hpp"

namespace loopbench::harness {
namespace {

template <class Value>
std::string field_text(const Value& value) {
  if constexpr (std::is_same_v<Value, SharedText>) {
    return quoted(value);
  } else if constexpr (std::is_same_v<Value, Status>) {
    return to_text(value);
  } else if constexpr (std::is_arithmetic_v<Value>) {
    return fmt::format("{}", value);
  } else {
    return value ? fmt::format("{}", *value) : "";
  }
}

/// The fields of rows_header(), quoted where necessary.
std::vector<std::string> fields_of(const Record& r) {
  const auto number = [](double x) { return std::isfinite(x) ? fmt::format("{}", x) : ""; };
  std::vector<std::string> out;
  fields(*r.cell, [&](const CellField& column, const auto& value) {
    if (column.name_in_rows[0] != '\0') out.push_back(field_text(value));
  });
  out.reserve(40);
  for (const KindField& each : kKindFields) {
    const bool is_label = each.text == &ScoreKind::label;
    out.push_back(quoted(is_label ? r.kind->metric_label() : (*r.kind).*each.text));
  }
  out.push_back(to_text(r.kind->better));
  out.push_back(r.kind->better == metrics::Better::target ? fmt::format("{}", r.kind->target) : "");
  // An undefined score has empty fields, not zeros.
  const bool has_scores = r.has_score() && has_numbers(r.status);
  const auto score = [&](const std::string& text) { out.push_back(has_scores ? text : ""); };
  const metrics::Statistics& s = r.statistics;
  score(fmt::format("{}", s.count));
  for (const auto& field : metrics::kStatisticFields) score(number(s.*field.member));
  score(fmt::format("{}", r.pairs));
  score(fmt::format("{}", r.possible));
  out.insert(out.end(), {number(r.cell->milliseconds()), quoted(to_text(r.status)), quoted(r.why)});
  out.push_back(field_text(r.cell->stated_times));  // new columns follow the old ones
  return out;
}

/// Whether a spreadsheet would evaluate the text. Numbers with a sign, also with a unit, and a dash
/// are no formulas.
bool is_formula(const std::string& text) {
  if (text.empty() || text == "-") return false;
  if (text[0] == '=' || text[0] == '@') return true;
  if (text[0] != '+' && text[0] != '-') return false;
  double value = 0.0;
  const auto [rest, error] =
      std::from_chars(text.data() + (text[0] == '+' ? 1 : 0), text.data() + text.size(), value);
  const auto is_unit = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == ' ' || c == '%' || c == '/';
  };
  return error != std::errc{} || !std::all_of(rest, text.data() + text.size(), is_unit);
}

}  // namespace

std::string quoted(const std::string& raw) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  if (std::ranges::all_of(raw, is_plain)) return raw;  // as most are
  const std::string text = (is_formula(raw) ? "'" : "") + printable(raw);
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string rows_header() {
  std::string out;
  const CellRow none;
  fields(none, [&](const CellField& column, const auto&) {
    if (column.name_in_rows[0] != '\0') out += std::string(column.name_in_rows) + ",";
  });
  for (const KindField& each : kKindFields) out += std::string(each.name) + ",";
  out += "better,target,count,";
  for (const auto& each : metrics::kStatisticFields) out += std::string(each.name) + ",";
  return out + "pairs,possible,milliseconds,status,why,stated_times\n";
}

std::string csv_row(const Record& record) {
  return fmt::format("{}\n", fmt::join(fields_of(record), ","));
}

std::string csv(const std::vector<Record>& records) {
  std::string out = rows_header();
  for (const Record& r : records) out += csv_row(r);
  return out;
}

}  // namespace loopbench::harness
