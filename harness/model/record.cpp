#include "harness/model/record.hpp"

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

}  // namespace

const SharedText& metric_label(const Record& record) {
  return record.label.empty() ? record.metric : record.label;
}

std::string field(const Record& record, const std::string& name) {
  if (name == "sequence") return record.sequence;
  if (name == "repeat") return std::to_string(record.repeat);
  if (name == "method") return record.method;
  if (name == "closures") return record.closures;
  if (name == "protocol") return record.protocol;
  if (name == "protocol_version") return record.protocol_version;
  if (name == "times") return record.times;
  if (name == "metric") return record.metric;
  if (name == "label") return metric_label(record);
  if (name == "relation") return record.relation;
  if (name == "axis") return record.axis;
  if (name == "unit") return record.unit;
  if (name == "status") return to_text(record.status);
  if (name == "score") return short_score(record);
  throw InputError(unknown_name("column",
                                name,
                                {"sequence",
                                 "repeat",
                                 "method",
                                 "closures",
                                 "protocol",
                                 "protocol_version",
                                 "times",
                                 "metric",
                                 "label",
                                 "relation",
                                 "axis",
                                 "unit",
                                 "status",
                                 "score"}));
}

double value(const Record& record, const std::string& name) {
  const metrics::Statistics& s = record.statistics;
  if (name == "rmse") return s.rmse;
  if (name == "mean") return s.mean;
  if (name == "median") return s.median;
  if (name == "std") return s.std;
  if (name == "min") return s.min;
  if (name == "max") return s.max;
  if (name == "sse") return s.sse;
  if (name == "count") return static_cast<double>(s.count);
  throw InputError(unknown_name(
      "statistic", name, {"rmse", "mean", "median", "std", "min", "max", "sse", "count"}));
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
