#include "harness/tables/table_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "harness/compare/observations.hpp"
#include "metrics/numerics/average.hpp"

namespace loopbench::harness {

std::string fields_joined(const Record& record,
                          const std::vector<std::string>& names,
                          const char* glue) {
  std::string out;
  for (const std::string& name : names) {
    const std::string text = field(record, name);
    if (!text.empty()) out += (out.empty() ? "" : glue) + text;
  }
  return out;
}

std::string run_key(const Record& r) {
  return r.cell->content.empty() ? r.cell->run_name() : r.cell->content.text();
}

void EntryNumbers::add(const Record& record,
                       std::size_t run,
                       std::size_t group,
                       const std::string& statistic) {
  values_.push_back({run, group, record.cell->method, value(record, statistic)});
  method_ = record.cell->method;
  is_gain_ = record.kind->metric == "gain" && statistic != "count";
  is_oracle_ = record.cell->oracle;
}

std::size_t EntryNumbers::averaged() const {
  return static_cast<std::size_t>(std::ranges::count(values_, true, &Value::is_kept));
}

RunSet EntryNumbers::finished() const {
  RunSet out;
  for (const Value& one : values_) {
    if (one.is_kept) out.insert(one.run);
  }
  return out;
}

void EntryNumbers::keep(const RunSet& runs) {
  for (Value& one : values_) one.is_kept = one.is_kept && runs.contains(one.run);
}

std::vector<double> EntryNumbers::kept() const {
  std::vector<double> out;
  out.reserve(values_.size());
  for (const Value& one : values_) {
    if (one.is_kept) out.push_back(one.value);
  }
  return out;
}

double EntryNumbers::gain() const {
  std::map<std::size_t, std::map<std::pair<SharedText, std::size_t>, double>> by_group;
  for (const Value& one : values_) {
    if (one.is_kept) by_group[one.group][{one.method, one.run}] = one.value;
  }
  std::vector<double> groups;
  for (const auto& [group, gains] : by_group) {
    std::vector<double> logarithms;
    for (const auto& [run, gain] : gains) logarithms.push_back(std::log(1.0 - 0.01 * gain));
    groups.push_back(metrics::mean(logarithms));
  }
  return 100.0 * (1.0 - std::exp(metrics::mean(groups)));
}

std::optional<double> EntryNumbers::average() const {
  const std::vector<double> all = kept();
  // One zero error would make the geometric mean zero.
  const auto zeros = std::ranges::count(all, 100.0);
  const bool has_no_mean = is_gain_ && zeros > 0 && zeros < std::ssize(all);
  if (all.empty() || has_no_mean) return std::nullopt;
  const double out = is_gain_ ? gain() : metrics::mean(all);
  return std::isfinite(out) ? std::optional(out) : std::nullopt;
}

std::optional<double> EntryNumbers::deviation() const {
  const std::vector<double> all = kept();
  if (all.size() < 2) return std::nullopt;
  const double out = metrics::sample_deviation(all);
  return std::isfinite(out) ? std::optional(out) : std::nullopt;
}

}  // namespace loopbench::harness
