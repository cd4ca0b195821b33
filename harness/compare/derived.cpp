#include "harness/compare/derived.hpp"

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
  one.statistics = {1, x, x, x, 0.0, x, x, x * x};
  return one;
}

bool has_time(const Record& r) { return !std::isnan(r.milliseconds); }

Record run_time(const Record& r) {
  static const SharedText metric = "time";
  static const SharedText unit = "ms";
  return one_number(r, metric, unit, metrics::Better::lower, r.milliseconds);
}

Record pair_count(const Record& r) {
  static const SharedText metric = "pairs";
  return one_number(r, metric, {}, metrics::Better::neither, static_cast<double>(r.pairs));
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
      g.status = Status::declined;
      g.why = "the error of the baseline " + baseline + " is zero";
    }
    out.push_back(g);
  }
  return out;
}

std::vector<Record> run_times(const std::vector<Record>& records) {
  std::vector<Record> out;
  for (const std::size_t i : first_scores(records)) {
    if (has_time(records[i])) out.push_back(run_time(records[i]));
  }
  return out;
}

std::vector<Record> pair_counts(const std::vector<Record>& records) {
  std::vector<Record> out;
  for (const std::size_t i : first_scores(records)) out.push_back(pair_count(records[i]));
  return out;
}

void add_derived(std::vector<Record>& records, const std::string& baseline) {
  const std::vector<Record> gain = gains(records, baseline);
  const std::vector<std::size_t> first = first_scores(records);
  records.reserve(records.size() + gain.size() + 2 * first.size());
  records.insert(records.end(), gain.begin(), gain.end());
  for (const std::size_t i : first) records.push_back(pair_count(records[i]));
  for (const std::size_t i : first) {
    if (has_time(records[i])) records.push_back(run_time(records[i]));
  }
}

}  // namespace loopbench::harness
