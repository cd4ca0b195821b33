#include "harness/tables/entry_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "harness/compare/observations.hpp"
#include "harness/statistics/average.hpp"

namespace loopbench::harness {

std::string run_key(const Record& r) { return r.content.empty() ? run_name(r) : r.content; }

void EntryNumbers::add(const Record& record, double value) {
  values_.push_back({run_key(record), group_name(record), record.method, value});
  ++added_;
  method_ = record.method;
  is_gain_ = record.metric == "gain";
  if (record.oracle) return;
  runs_[run_key(record)] = value;
  better_ = record.better;
  target_ = record.target;
}

std::set<std::string> EntryNumbers::finished() const {
  std::set<std::string> out;
  for (const Value& one : values_) out.insert(one.run);
  return out;
}

void EntryNumbers::keep(const std::set<std::string>& runs) {
  std::erase_if(values_, [&](const Value& one) { return !runs.contains(one.run); });
}

double EntryNumbers::gain() const {
  std::map<std::string, std::map<std::pair<std::string, std::string>, double>> by_group;
  for (const Value& one : values_) by_group[one.group][{one.method, one.run}] = one.value;
  std::vector<double> groups;
  for (const auto& [group, gains] : by_group) {
    std::vector<double> logarithms;
    for (const auto& [run, gain] : gains) logarithms.push_back(std::log(1.0 - 0.01 * gain));
    groups.push_back(mean(logarithms));
  }
  return 100.0 * (1.0 - std::exp(mean(groups)));
}

std::optional<double> EntryNumbers::average() const {
  // One zero error would make the geometric mean zero.
  const auto zeros = std::ranges::count(values_, 100.0, &Value::value);
  const bool has_no_mean = is_gain_ && zeros > 0 && zeros < std::ssize(values_);
  if (values_.empty() || has_no_mean) return std::nullopt;
  std::vector<double> all;
  for (const Value& one : values_) all.push_back(one.value);
  const double out = is_gain_ ? gain() : mean(all);
  return std::isfinite(out) ? std::optional(out) : std::nullopt;
}

std::optional<double> EntryNumbers::deviation() const {
  if (values_.size() < 2) return std::nullopt;
  std::vector<double> all;
  for (const Value& one : values_) all.push_back(one.value);
  const double centre = mean(all);
  double squares = 0.0;
  for (const double value : all) squares += (value - centre) * (value - centre);
  const double out = std::sqrt(squares / static_cast<double>(all.size() - 1));
  return std::isfinite(out) ? std::optional(out) : std::nullopt;
}

}  // namespace loopbench::harness
