#include "harness/execution/run/add_scores.hpp"

#include <cmath>
#include <iterator>

#include "datasets/core/parallel.hpp"
#include "harness/catalogue/floating_point_guard.hpp"
#include "harness/execution/run/catch_errors.hpp"
#include "harness/execution/run/incomplete.hpp"

namespace loopbench::harness {
namespace {

bool is_finite(const metrics::Statistics& s) {
  return std::isfinite(s.rmse) && std::isfinite(s.mean) && std::isfinite(s.median) &&
         std::isfinite(s.std) && std::isfinite(s.min) && std::isfinite(s.max) &&
         std::isfinite(s.sse);
}

}  // namespace

std::vector<ScoreResult> scores_of(const MetricChoice& choice,
                                   ScoreResult row,
                                   const metrics::Evaluation& evaluation,
                                   const Catalogue& catalogue) {
  std::vector<ScoreResult> out;
  row.metric = choice.metric.name;
  row.label = choice.label;
  row.coverage = evaluation.coverage;
  catch_errors(row, [&] {
    const metrics::MetricEntry& metric = find_metric(catalogue, choice.metric.name);
    std::vector<metrics::Score> scores = [&] {
      const FloatingPointGuard guard;  // for the metrics after it
      return metric.score(evaluation, choice.metric.options);
    }();
    check_scores(scores);
    for (metrics::Score& score : scores) {
      ScoreResult& added = out.emplace_back(row);
      if (!score.why_undefined.empty()) {
        added.status = Status::declined;
        added.why = score.why_undefined;
      } else if (!is_finite(score.statistics)) {
        added.status = Status::failed;
        added.why = "is not finite";
        score.statistics = {};
      }
      added.score = std::move(score);
    }
  });
  const bool has_thrown = is_failure(row.status) || row.status == Status::declined;
  if (has_thrown) out.push_back(row);
  return out;
}

void add_scores(CellResult& result,
                ScoreResult row,
                const metrics::Evaluation& evaluation,
                const Sweep& sweep,
                const Catalogue& catalogue,
                bool parallel) {
  row.why = incomplete_reason(evaluation.coverage, sweep.min_coverage);
  if (!row.why.empty()) {
    row.status = Status::incomplete;
    result.status = Status::incomplete;
    result.why = to_text(row.times) + ": " + row.why;
  }
  std::vector<std::vector<ScoreResult>> scores(sweep.metrics.size());
  const auto evaluate = [&](std::size_t i) {
    scores[i] = scores_of(sweep.metrics[i], row, evaluation, catalogue);
  };
  if (parallel) {
    // The last first: in the default list, segments take the longest.
    parallel_for_tasks(scores.size(), [&](std::size_t i) { evaluate(scores.size() - 1 - i); });
  } else {
    for (std::size_t i = 0; i < scores.size(); ++i) evaluate(i);
  }
  for (auto& each : scores) std::ranges::move(each, std::back_inserter(result.scores));
}

void add_failure(CellResult& result, ScoreResult failure, const Sweep& sweep) {
  for (const MetricChoice& choice : sweep.metrics) {
    failure.metric = choice.metric.name;
    failure.label = choice.label;
    result.scores.push_back(failure);
  }
}

}  // namespace loopbench::harness
