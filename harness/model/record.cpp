#include "harness/model/record.hpp"

#include <utility>

#include "datasets/core/error.hpp"
#include "harness/base/suggest.hpp"

namespace loopbench::harness {
namespace {

std::string short_score(const Record& record) {
  std::string out = metric_label(record);
  if (record.relation != "translation" && record.relation != "rotation") {
    out += " " + record.relation;
  }
  if (record.axis != "3d") out += " " + record.axis;
  while (out.ends_with(' ')) out.pop_back();
  return out;
}

using FieldText = std::string (*)(const Record&);
constexpr std::pair<const char*, FieldText> kFields[] = {
    {"sequence", [](const Record& r) { return r.sequence.text(); }},
    {"repeat", [](const Record& r) { return std::to_string(r.repeat); }},
    {"method", [](const Record& r) { return r.method.text(); }},
    {"closures", [](const Record& r) { return r.closures.text(); }},
    {"protocol", [](const Record& r) { return r.protocol.text(); }},
    {"protocol_version", [](const Record& r) { return r.protocol_version.text(); }},
    {"times", [](const Record& r) { return r.times.text(); }},
    {"metric", [](const Record& r) { return r.metric.text(); }},
    {"label", [](const Record& r) { return metric_label(r).text(); }},
    {"relation", [](const Record& r) { return r.relation.text(); }},
    {"axis", [](const Record& r) { return r.axis.text(); }},
    {"unit", [](const Record& r) { return r.unit.text(); }},
    {"status", [](const Record& r) { return to_text(r.status); }},
    {"score", short_score}};

using StatisticNumber = double (*)(const metrics::Statistics&);
constexpr std::pair<const char*, StatisticNumber> kStatistics[] = {
    {"rmse", [](const metrics::Statistics& s) { return s.rmse; }},
    {"mean", [](const metrics::Statistics& s) { return s.mean; }},
    {"median", [](const metrics::Statistics& s) { return s.median; }},
    {"p50", [](const metrics::Statistics& s) { return s.median; }},
    {"p90", [](const metrics::Statistics& s) { return s.p90; }},
    {"p95", [](const metrics::Statistics& s) { return s.p95; }},
    {"p99", [](const metrics::Statistics& s) { return s.p99; }},
    {"std", [](const metrics::Statistics& s) { return s.std; }},
    {"min", [](const metrics::Statistics& s) { return s.min; }},
    {"max", [](const metrics::Statistics& s) { return s.max; }},
    {"sse", [](const metrics::Statistics& s) { return s.sse; }},
    {"count", [](const metrics::Statistics& s) { return static_cast<double>(s.count); }}};

template <class Table>
std::vector<std::string> known_names(const Table& table) {
  std::vector<std::string> out;
  for (const auto& entry : table) out.emplace_back(entry.first);
  return out;
}

}  // namespace

const SharedText& metric_label(const Record& record) {
  return record.label.empty() ? record.metric : record.label;
}

std::string field(const Record& record, const std::string& name) {
  for (const auto& [known, text] : kFields) {
    if (name == known) return text(record);
  }
  throw InputError(unknown_name("column", name, known_names(kFields)));
}

double value(const Record& record, const std::string& name) {
  for (const auto& [known, number] : kStatistics) {
    if (name == known) return number(record.statistics);
  }
  throw InputError(unknown_name("statistic", name, known_names(kStatistics)));
}

bool has_direction(const std::string& statistic) {
  return statistic != "count" && statistic != "sse";
}

metrics::Better direction_of(const Record& record, const std::string& statistic) {
  return has_direction(statistic) ? record.better : metrics::Better::neither;
}

std::string unit_of(const Record& record, const std::string& statistic) {
  const std::string unit = record.unit;
  if (statistic == "count") return "";
  // The sum of squares of a gain is the gain of the sum of squares.
  const bool is_squared = statistic == "sse" && record.metric != "gain";
  if (!is_squared || unit.empty() || unit == "1") return unit;
  const bool is_product = unit.find_first_of("/* ^") != std::string::npos;
  return (is_product ? "(" + unit + ")" : unit) + "^2";
}

}  // namespace loopbench::harness
