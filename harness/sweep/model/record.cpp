#include "harness/sweep/model/record.hpp"

#include <algorithm>
#include <limits>

#include "datasets/core/error.hpp"
#include "harness/sweep/model/record_columns.hpp"
#include "harness/sweep/text/suggest.hpp"

namespace loopbench::harness {

double CellRow::milliseconds() const {
  const bool is_unknown = runs == 0 && has_numbers(status);
  return is_unknown ? std::numeric_limits<double>::quiet_NaN() : seconds * 1000;
}

std::string CellRow::run_name() const {
  return repeat == 0 ? sequence.text() : sequence + " (repeat " + std::to_string(repeat) + ")";
}

std::string ScoreKind::short_name() const {
  std::string out = metric_label();
  if (relation != "translation" && relation != "rotation") out += " " + relation;
  if (axis != "3d") out += " " + axis;
  while (out.ends_with(' ')) out.pop_back();
  return out;
}

std::string ScoreKind::name() const {
  std::string out = metric_label();
  for (const std::string& word : {relation, axis}) {
    if (!word.empty()) out += " " + word;
  }
  return out + ", " + times + ", " + protocol;
}

namespace {

/// The value of the first stage of the method that has the option.
std::optional<std::string> option_of(const CellRow& cell, const std::string& name) {
  for (const Choice& stage : *cell.stages) {
    const auto found = stage.options.find(name);
    if (found != stage.options.end()) return to_text(found->second);
  }
  return std::nullopt;
}

const RecordColumn* column_named(const std::string& name) {
  const auto* const found = std::ranges::find(kRecordColumns, name, &RecordColumn::name);
  return found == std::end(kRecordColumns) ? nullptr : found;
}

}  // namespace

std::vector<std::string> record_columns() {
  std::vector<std::string> out;
  for (const RecordColumn& each : kRecordColumns) out.emplace_back(each.name);
  return out;
}

bool has_field(const Record& record, const std::string& name) {
  return column_named(name) != nullptr || option_of(*record.cell, name);
}

std::string field(const Record& record, const std::string& name) {
  if (const RecordColumn* const column = column_named(name)) return column->text(record);
  if (const auto option = option_of(*record.cell, name)) return *option;
  throw InputError(unknown_name("column", name, record_columns()));
}

double value(const Record& record, const std::string& name) {
  if (name == "count") return static_cast<double>(record.statistics.count);
  return record.statistics.*member_of(name);
}

double metrics::Statistics::*member_of(const std::string& statistic) {
  const std::string name = statistic == "p50" ? "median" : statistic;
  for (const auto& each : metrics::kStatisticFields) {
    if (name == each.name) return each.member;
  }
  throw InputError(unknown_name("statistic", statistic, statistic_names()));
}

std::vector<std::string> statistic_names() {
  std::vector<std::string> out;
  for (const auto& field : metrics::kStatisticFields) out.emplace_back(field.name);
  out.emplace_back("count");
  return out;
}

std::vector<std::string> directed_statistics() {
  std::vector<std::string> out = statistic_names();
  std::erase_if(out, [](const std::string& name) { return !has_direction(name); });
  return out;
}

bool has_direction(const std::string& statistic) {
  return statistic != "count" && statistic != "sse";
}

metrics::Better direction_of(const ScoreKind& kind, const std::string& statistic) {
  return has_direction(statistic) ? kind.better : metrics::Better::neither;
}

int sign_of_ratio(const std::string& metric) {
  if (metric == "gain") return -1;
  return metric == "change" ? 1 : 0;
}

std::string unit_of(const ScoreKind& kind, const std::string& statistic) {
  const std::string& unit = kind.unit;
  if (statistic == "count") return "";
  // The sum of squares of a gain or change is that of the sum of squares.
  const bool is_squared = statistic == "sse" && sign_of_ratio(kind.metric) == 0;
  if (!is_squared || unit.empty() || unit == "1") return unit;
  const bool is_product = unit.find_first_of("/* ^") != std::string::npos;
  return (is_product ? "(" + unit + ")" : unit) + "^2";
}

}  // namespace loopbench::harness
