#include "harness/tables/cell_numbers.hpp"

#include <algorithm>
#include <cmath>

#include "harness/compare/observations.hpp"
#include "harness/statistics/average.hpp"

namespace loopbench {

std::string run_key(const Record& r) { return r.content.empty() ? run_name(r) : r.content; }

void CellNumbers::add(const Record& record, double value) {
  values_.push_back(value);
  method_ = record.method;
  is_gain_ = record.metric == "gain";
  by_group_[group_name(record)][record.method + "\n" + run_key(record)] = value;
  if (record.oracle) return;
  runs_[run_key(record)] = value;
  better_ = record.better;
  target_ = record.target;
}

double CellNumbers::gain() const {
  std::vector<double> groups;
  for (const auto& [group, gains] : by_group_) {
    std::vector<double> logarithms;
    for (const auto& [run, gain] : gains) logarithms.push_back(std::log(1.0 - 0.01 * gain));
    groups.push_back(mean(logarithms));
  }
  return 100.0 * (1.0 - std::exp(mean(groups)));
}

std::optional<double> CellNumbers::average() const {
  // One zero error would make the geometric mean zero.
  const auto zeros = std::ranges::count(values_, 100.0);
  const bool has_no_mean = is_gain_ && zeros > 0 && zeros < std::ssize(values_);
  if (values_.empty() || has_no_mean) return std::nullopt;
  const double out = is_gain_ ? gain() : mean(values_);
  return std::isfinite(out) ? std::optional(out) : std::nullopt;
}

}  // namespace loopbench
