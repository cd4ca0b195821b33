#include "harness/compare/derived.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>

#include "harness/compare/levels.hpp"

namespace loopbench::harness {
namespace {

auto comparison_key(const Record& r) {
  return std::tie(r.sequence, r.repeat, r.protocol, r.times, metric_label(r), r.axis);
}
using RowPlace =
    std::tuple<SharedText, std::int64_t, SharedText, SharedText, SharedText, SharedText>;

const SharedText kAte = "ate";
const SharedText kTranslation = "translation";

bool is_gain_source(const Record& r) {
  return r.metric == kAte && r.relation == kTranslation && r.status == Status::ok;
}

/// NaN if the baseline has zero error.
double gain(double value, double baseline) {
  if (baseline <= zero_floor(std::max(value, baseline))) return std::nan("");
  return 100.0 * (1.0 - value / baseline);
}

/// The first scores of each cell, protocol and times, by index.
std::vector<std::size_t> first_scores(const std::vector<Record>& records) {
  std::vector<std::size_t> out;
  std::set<std::tuple<std::int64_t, SharedText, SharedText>> seen;
  const Record* last = nullptr;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Record& r = records[i];
    if (r.status != Status::ok || r.metric.empty()) continue;
    const bool is_like_last = last != nullptr && last->cell == r.cell &&
                              last->protocol == r.protocol && last->times == r.times;
    last = &r;
    if (!is_like_last && seen.emplace(r.cell, r.protocol, r.times).second) out.push_back(i);
  }
  return out;
}

/// A score of a single number: every statistic has this value.
Record one_number(const Record& r,
                  const SharedText& metric,
                  const SharedText& unit,
                  metrics::Better better,
                  double x) {
  Record one = r;
  one.metric = metric;
  one.label.clear();
  one.better = better;
  one.relation = one.axis = {};
  one.unit = unit;
  for (const auto& each : metrics::kStatisticFields) one.statistics.*each.member = x;
  one.statistics.count = 1;
  one.statistics.std = 0.0;
  one.statistics.sse = x * x;
  return one;
}

}  // namespace

std::vector<Record> gains(const std::vector<Record>& records, const std::string& baseline) {
  std::map<RowPlace, const metrics::Statistics*> base;
  for (const Record& r : records) {
    if (is_gain_source(r) && r.method == baseline) base.emplace(comparison_key(r), &r.statistics);
  }
  const SharedText metric = "gain";
  const SharedText unit = "%";
  std::vector<Record> out;
  for (const Record& r : records) {
    const auto found = is_gain_source(r) ? base.find(comparison_key(r)) : base.end();
    if (found == base.end()) continue;
    const metrics::Statistics& b = *found->second;
    Record g = r;
    g.metric = metric;
    g.label = metric_label(r) == "ate" ? "" : "gain (" + metric_label(r) + ")";
    g.better = metrics::Better::higher;
    g.unit = unit;
    for (const auto& each : metrics::kStatisticFields) {
      g.statistics.*each.member = gain(r.statistics.*each.member, b.*each.member);
    }
    if (!std::isfinite(g.statistics.rmse)) {
      g.status = Status::declined;
      g.why = "the error of the baseline " + baseline + " is zero";
    }
    out.push_back(g);
  }
  return out;
}

std::vector<Record> run_times(const std::vector<Record>& records) {
  const SharedText metric = "time";
  const SharedText unit = "ms";
  std::vector<Record> out;
  for (const std::size_t i : first_scores(records)) {
    const Record& r = records[i];
    if (std::isnan(r.milliseconds)) continue;
    out.push_back(one_number(r, metric, unit, metrics::Better::lower, r.milliseconds));
  }
  return out;
}

std::vector<Record> pair_counts(const std::vector<Record>& records) {
  const SharedText metric = "pairs";
  std::vector<Record> out;
  for (const std::size_t i : first_scores(records)) {
    const auto pairs = static_cast<double>(records[i].pairs);
    out.push_back(one_number(records[i], metric, {}, metrics::Better::neither, pairs));
  }
  return out;
}

void add_derived(std::vector<Record>& records, const std::string& baseline) {
  std::vector<Record> derived = gains(records, baseline);
  std::ranges::move(pair_counts(records), std::back_inserter(derived));
  std::ranges::move(run_times(records), std::back_inserter(derived));
  std::ranges::move(derived, std::back_inserter(records));
}

}  // namespace loopbench::harness
