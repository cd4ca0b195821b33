#include "harness/store/failed_metrics.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace loopbench::harness {
namespace {

using MetricKey = std::tuple<std::string, std::string, std::string, std::string>;
using RunKey = std::pair<std::string, std::int64_t>;

MetricKey metric_key(const Record& r) { return {r.protocol, r.times, r.metric, metric_label(r)}; }

/// A record without relation: the metric has no scores.
bool is_failed_metric(const Record& r) {
  return !r.metric.empty() && r.status != "ok" && r.relation.empty();
}

/// The scores of a metric in order of first appearance.
using Scores = std::vector<const Record*>;

void add(Scores& scores, const Record& r) {
  const auto is_same = [&](const Record* s) {
    return s->relation == r.relation && s->axis == r.axis && s->unit == r.unit;
  };
  if (std::ranges::none_of(scores, is_same)) scores.push_back(&r);
}

}  // namespace

void expand_failed_metrics(std::vector<Record>& records) {
  if (std::ranges::none_of(records, is_failed_metric)) return;
  std::map<MetricKey, Scores> anywhere;
  std::map<std::pair<MetricKey, RunKey>, Scores> on_run;
  for (const Record& r : records) {
    if (r.metric.empty() || r.relation.empty()) continue;
    add(anywhere[metric_key(r)], r);
    add(on_run[{metric_key(r), {r.sequence, r.repeat}}], r);
  }
  std::vector<Record> out;
  for (const Record& r : records) {
    const Scores* scores = nullptr;
    if (is_failed_metric(r)) {
      const auto here = on_run.find({metric_key(r), {r.sequence, r.repeat}});
      const auto there = anywhere.find(metric_key(r));
      if (here != on_run.end()) {
        scores = &here->second;
      } else if (there != anywhere.end()) {
        scores = &there->second;
      }
    }
    if (scores == nullptr) {
      out.push_back(r);
      continue;
    }
    for (const Record* score : *scores) {
      Record& named = out.emplace_back(r);
      named.relation = score->relation;
      named.axis = score->axis;
      named.unit = score->unit;
      named.better = score->better;
      named.target = score->target;
    }
  }
  records = std::move(out);
}

}  // namespace loopbench::harness
