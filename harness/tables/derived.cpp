#include "harness/tables/derived.hpp"

#include <algorithm>
#include <cmath>
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

bool is_gain_source(const Record& r) {
  return r.metric == "ate" && r.relation == "translation" && r.status == "ok";
}

/// NaN if the baseline has zero error.
double gain(double value, double baseline) {
  if (baseline <= zero_floor(std::max(value, baseline))) return std::nan("");
  return 100.0 * (1.0 - value / baseline);
}

/// A score of a single number: every statistic has this value.
template <class Number>
std::vector<Record> one_per_cell(const std::vector<Record>& records,
                                 const SharedText& metric,
                                 const SharedText& unit,
                                 metrics::Better better,
                                 Number number) {
  std::vector<Record> out;
  std::set<std::tuple<std::int64_t, SharedText, SharedText>> seen;
  const Record* last = nullptr;
  for (const Record& r : records) {
    if (r.status != "ok" || r.metric.empty()) continue;
    const bool is_like_last = last != nullptr && last->cell == r.cell &&
                              last->protocol == r.protocol && last->times == r.times;
    last = &r;
    if (is_like_last || !seen.emplace(r.cell, r.protocol, r.times).second) continue;
    Record one = r;
    one.metric = metric;
    one.label.clear();
    one.better = better;
    one.relation = one.axis = {};
    one.unit = unit;
    const double x = number(r);
    one.statistics = {1, x, x, x, 0.0, x, x, x * x};
    out.push_back(one);
  }
  return out;
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
    for (double metrics::Statistics::*number : {&metrics::Statistics::rmse,
                                                &metrics::Statistics::mean,
                                                &metrics::Statistics::median,
                                                &metrics::Statistics::std,
                                                &metrics::Statistics::min,
                                                &metrics::Statistics::max,
                                                &metrics::Statistics::sse}) {
      g.statistics.*number = gain(r.statistics.*number, b.*number);
    }
    if (!std::isfinite(g.statistics.rmse)) {
      g.status = "declined";
      g.why = "the error of the baseline " + baseline + " is zero";
    }
    out.push_back(g);
  }
  return out;
}

std::vector<Record> run_times(const std::vector<Record>& records) {
  return one_per_cell(records, "time", "ms", metrics::Better::lower, [](const Record& r) {
    return r.milliseconds;
  });
}

std::vector<Record> pair_counts(const std::vector<Record>& records) {
  return one_per_cell(records, "pairs", "", metrics::Better::neither, [](const Record& r) {
    return static_cast<double>(r.pairs);
  });
}

}  // namespace loopbench::harness
