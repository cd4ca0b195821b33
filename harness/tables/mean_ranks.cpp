#include "harness/tables/mean_ranks.hpp"

#include <algorithm>
#include <cmath>

#include "harness/compare/observations.hpp"
#include "harness/statistics/ranks.hpp"

namespace loopbench::harness {
namespace {

/// A value for which lower is better.
double as_loss(double value, const Record& kind) {
  switch (kind.better) {
    case metrics::Better::higher:
      return -value;
    case metrics::Better::target:
      return std::abs(value - kind.target);
    default:
      return value;
  }
}

}  // namespace

std::map<std::string, double> mean_ranks(const std::vector<Record>& records,
                                         const std::string& value) {
  std::vector<Record> ranked = records;
  std::erase_if(ranked, [](const Record& r) { return r.oracle; });
  const std::vector<Observations> all = observations(ranked, value);
  if (all.empty()) return {};
  Observations kind = all.front();
  if (kind.kind.better == metrics::Better::neither) return {};
  drop_duplicates(kind);
  std::map<std::string, std::vector<double>> ranks;
  for (std::size_t run = 0; run < kind.runs.size(); ++run) {
    std::vector<std::string> finished;
    std::vector<std::string> lost;
    std::vector<double> values;
    for (std::size_t m = 0; m < kind.methods.size(); ++m) {
      const Observed& one = kind.values[m][run];
      if (one.value) {
        finished.push_back(kind.methods[m]);
        values.push_back(as_loss(*one.value, kind.kind));
      } else if (one.is_loss) {
        lost.push_back(kind.methods[m]);
      }
    }
    if (finished.empty()) continue;
    const std::vector<double> own = midranks(values, kRelevant);
    for (std::size_t i = 0; i < own.size(); ++i) ranks[finished[i]].push_back(own[i]);
    const double last =
        static_cast<double>(finished.size()) + 0.5 * (static_cast<double>(lost.size()) + 1.0);
    for (const std::string& method : lost) ranks[method].push_back(last);
  }
  std::map<std::string, double> out;
  for (const auto& [method, own] : ranks) {
    double sum = 0.0;
    for (const double rank : own) sum += rank;
    out[method] = sum / static_cast<double>(own.size());
  }
  return out;
}

}  // namespace loopbench::harness
