#include "harness/report/compare_in_parts.hpp"

#include <algorithm>
#include <iterator>

namespace loopbench::harness {

void ComparedMetrics::add(const Record& r) {
  if (r.metric.empty() || r.better == metrics::Better::neither) return;
  const MetricLabel own{r.metric, r.label};
  const auto [found, is_new] = index_.emplace(own, metrics_.size());
  if (is_new) metrics_.push_back({own, 0});
  ++metrics_[found->second].second;
  ++total_;
}

std::vector<std::set<ComparedMetrics::MetricLabel>> ComparedMetrics::parts() const {
  std::vector<std::set<MetricLabel>> out;
  std::size_t scores = kMostValues;
  for (const auto& [metric, own] : metrics_) {
    if (scores + own > kMostValues) {
      out.emplace_back();
      scores = 0;
    }
    scores += own;
    out.back().insert(metric);
  }
  return out;
}

std::vector<Comparison> compare_in_parts(RecordReader& reader,
                                         const ComparedMetrics& metrics,
                                         const std::string& baseline) {
  CompareOptions options;
  options.baseline = baseline;
  const RecordSource source = [&](const auto& visit) { reader.for_each(visit); };
  if (metrics.is_small()) return compare(source, options);
  std::vector<Comparison> out;
  for (const auto& part : metrics.parts()) {
    reader.keep_scores([&](const Record& r) { return part.contains({r.metric, r.label}); });
    std::ranges::move(compare(source, options), std::back_inserter(out));
  }
  return out;
}

}  // namespace loopbench::harness
