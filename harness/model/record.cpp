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

}  // namespace

const SharedText& metric_label(const Record& record) {
  return record.label.empty() ? record.metric : record.label;
}

std::string field(const Record& record, const std::string& name) {
  for (const auto& [known, text] : kFields) {
    if (name == known) return text(record);
  }
  std::vector<std::string> all;
  for (const auto& entry : kFields) all.emplace_back(entry.first);
  throw InputError(unknown_name("column", name, all));
}

double value(const Record& record, const std::string& name) {
  if (name == "count") return static_cast<double>(record.statistics.count);
  for (const auto& [known, member, share] : metrics::kStatisticFields) {
    if (name == known || (name == "p50" && member == &metrics::Statistics::median)) {
      return record.statistics.*member;
    }
  }
  throw InputError(unknown_name("statistic", name, statistic_names()));
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
