#include "harness/eval/group_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/numerics/percentile.hpp"

namespace loopbench::harness {
namespace {

struct GroupScore {
  std::string name;
  std::vector<double> values = {};
  double squares = 0.0;  ///< sum over all errors
  double count = 0.0;    ///< of these errors
};

bool is_summarised(const Record& record) {
  const bool is_total = record.axis == "3d" || record.axis == "all";
  return is_total && has_numbers(record.status) &&
         (record.metric == "ate" || record.metric == "rpe");
}

}  // namespace

Table group_summary(const std::vector<EvaluationResult>& results, bool is_pairwise) {
  const bool has_methods =
      !is_pairwise && std::ranges::any_of(results, [&](const EvaluationResult& result) {
        return result.reference != results.front().reference;
      });
  std::vector<GroupScore> scores;
  for (const EvaluationResult& result : results) {
    for (const Record& record : result.records) {
      if (!is_summarised(record)) continue;
      const std::string statistic = to_text(result.protocol.rules.statistic);
      const std::string name = fmt::format("{}{} {}, {} [{}], {}",
                                           has_methods ? record.method.text() + ": " : "",
                                           metric_label(record).text(),
                                           record.relation.text(),
                                           statistic,
                                           record.unit.text(),
                                           result.protocol.label());
      auto found = std::ranges::find(scores, name, &GroupScore::name);
      if (found == scores.end()) found = scores.insert(scores.end(), {name});
      found->values.push_back(value(record, statistic));
      found->squares += record.statistics.sse;
      found->count += static_cast<double>(record.statistics.count);
    }
  }
  Table out{is_pairwise ? "differences between runs, without a reference"
                        : "over all estimates, aligned together",
            {"score",
             is_pairwise ? "pairs" : "estimates",
             "median",
             "min",
             "max",
             "interquartile range",
             "rmse of all"},
            {},
            {}};
  for (auto& [name, values, squares, count] : scores) {
    std::ranges::sort(values);
    std::vector<TableCell>& line = out.lines.emplace_back();
    line = {name, std::to_string(values.size())};
    const double range = metrics::percentile(values, 0.75) - metrics::percentile(values, 0.25);
    for (const double each : {metrics::percentile(values, 0.5),
                              values.front(),
                              values.back(),
                              range,
                              std::sqrt(squares / count)}) {
      line.push_back({fmt::format("{:.4g}", each)});
    }
  }
  return out;
}

}  // namespace loopbench::harness
