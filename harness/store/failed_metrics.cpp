#include "harness/store/failed_metrics.hpp"

#include <algorithm>
#include <utility>

namespace loopbench::harness {
namespace {

using RunKey = std::pair<std::string, std::int64_t>;
using MetricKey = FailedMetrics::MetricKey;
using Scores = FailedMetrics::Scores;

MetricKey metric_key(const Record& r) { return {r.protocol, r.times, r.metric, metric_label(r)}; }

/// A record without relation: the metric has no scores.
bool is_failed_metric(const Record& r) {
  return !r.metric.empty() && r.status != Status::ok && r.relation.empty();
}

void add_score(Scores& scores, const Record& r) {
  const auto is_same = [&](const Record& s) {
    return s.relation == r.relation && s.axis == r.axis && s.unit == r.unit;
  };
  if (std::ranges::none_of(scores, is_same)) scores.push_back(r);
}

}  // namespace

void FailedMetrics::add(const Record& r) {
  if (!r.metric.empty() && !r.relation.empty()) add_score(anywhere_[metric_key(r)], r);
}

void FailedMetrics::expand(std::vector<Record>& records) const {
  if (std::ranges::none_of(records, is_failed_metric)) return;
  std::map<std::pair<MetricKey, RunKey>, Scores> on_run;
  for (const Record& r : records) {
    if (r.metric.empty() || r.relation.empty()) continue;
    add_score(on_run[{metric_key(r), {r.sequence, r.repeat}}], r);
  }
  std::vector<Record> out;
  for (const Record& r : records) {
    const Scores* scores = nullptr;
    if (is_failed_metric(r)) {
      const auto here = on_run.find({metric_key(r), {r.sequence, r.repeat}});
      const auto there = anywhere_.find(metric_key(r));
      if (here != on_run.end()) {
        scores = &here->second;
      } else if (there != anywhere_.end()) {
        scores = &there->second;
      }
    }
    if (scores == nullptr) {
      out.push_back(r);
      continue;
    }
    for (const Record& score : *scores) {
      Record& named = out.emplace_back(r);
      named.relation = score.relation;
      named.axis = score.axis;
      named.unit = score.unit;
      named.better = score.better;
      named.target = score.target;
    }
  }
  records = std::move(out);
}

}  // namespace loopbench::harness
