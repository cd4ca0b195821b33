#include "harness/run/add_scores.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "datasets/core/parallel.hpp"
#include "harness/run/catch_errors.hpp"
#include "harness/run/input_guard.hpp"

namespace loopbench::harness {
namespace {

bool is_finite(const metrics::Statistics& s) {
  return std::isfinite(s.rmse) && std::isfinite(s.mean) && std::isfinite(s.median) &&
         std::isfinite(s.std) && std::isfinite(s.min) && std::isfinite(s.max) &&
         std::isfinite(s.sse);
}

struct Scores {
  std::vector<ScoreResult> rows;
  std::string fault;  ///< what the metric changed
};

Scores scores_of(const MetricChoice& choice,
                 ScoreResult row,
                 const metrics::Evaluation& evaluation,
                 const Catalogue& catalogue) {
  Scores out;
  row.metric = choice.metric.name;
  row.label = choice.label;
  row.coverage = evaluation.coverage;
  const metrics::MetricEntry& metric = find_metric(catalogue, choice.metric.name);
  const bool is_foreign = !plugin_version(catalogue, "metric", metric.name).empty();
  const InputGuard guard(is_foreign ? inputs_of(evaluation) : Inputs());
  catch_errors(row, [&] {
    std::vector<metrics::Score> scores = metric.score(evaluation, choice.metric.options);
    check_scores(scores);
    for (metrics::Score& score : scores) {
      ScoreResult& added = out.rows.emplace_back(row);
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
  if (is_foreign) out.fault = guard.fault();
  const bool has_thrown = is_failure(row.status) || row.status == Status::declined;
  if (has_thrown) out.rows.push_back(row);
  return out;
}

void take(Scores scores, const MetricChoice& choice, CellResult& result) {
  std::ranges::move(scores.rows, std::back_inserter(result.scores));
  if (scores.fault.empty()) return;
  result.status = Status::failed;
  result.why = "metric '" + choice.metric.name + "' " + scores.fault;
}

}  // namespace

void add_scores_of(CellResult& result,
                   const MetricChoice& choice,
                   const ScoreResult& row,
                   const metrics::Evaluation& evaluation,
                   const Catalogue& catalogue) {
  take(scores_of(choice, row, evaluation, catalogue), choice, result);
}

void add_scores(CellResult& result,
                ScoreResult row,
                const metrics::Evaluation& evaluation,
                const Sweep& sweep,
                const Catalogue& catalogue,
                bool parallel) {
  row.why = incomplete_reason(evaluation.coverage, sweep.min_coverage);
  if (!row.why.empty()) row.status = Status::incomplete;
  if (!row.why.empty() && !is_failure(result.status)) {
    result.status = Status::incomplete;
    result.why = to_text(row.times) + ": " + row.why;
  }
  std::vector<Scores> scores(sweep.metrics.size());
  const auto evaluate = [&](std::size_t i) {
    scores[i] = scores_of(sweep.metrics[i], row, evaluation, catalogue);
  };
  if (parallel) {
    // The last first: in the default list, segments take the longest.
    parallel_for_tasks(scores.size(), [&](std::size_t i) { evaluate(scores.size() - 1 - i); });
  } else {
    for (std::size_t i = 0; i < scores.size(); ++i) evaluate(i);
  }
  for (std::size_t i = 0; i < scores.size(); ++i) {
    take(std::move(scores[i]), sweep.metrics[i], result);
  }
}

void add_failure(CellResult& result, ScoreResult failure, const Sweep& sweep) {
  for (const MetricChoice& choice : sweep.metrics) {
    failure.metric = choice.metric.name;
    failure.label = choice.label;
    result.scores.push_back(failure);
  }
}

std::string incomplete_reason(const metrics::Coverage& coverage, double min_coverage) {
  if (coverage.least() >= min_coverage) return "";
  return fmt::format(
      "evaluated {} of {} poses over {:.1f} % of the reference's time, below {:.1f} %",
      coverage.pairs,
      coverage.possible,
      100.0 * coverage.span,
      100.0 * min_coverage);
}

}  // namespace loopbench::harness
