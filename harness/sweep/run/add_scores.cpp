#include "harness/sweep/run/add_scores.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "datasets/core/parallel.hpp"
#include "harness/sweep/catalogue/command_metric.hpp"
#include "harness/sweep/catalogue/external_methods.hpp"
#include "harness/sweep/catalogue/floating_point_guard.hpp"
#include "harness/sweep/run/check_output.hpp"
#include "harness/sweep/run/watched_process.hpp"

namespace loopbench::harness {
namespace {

bool is_finite(const metrics::Statistics& s) {
  return std::ranges::all_of(metrics::kStatisticFields,
                             [&](const auto& field) { return std::isfinite(s.*field.member); });
}

/// A copy of all that a metric reads: that of a plugin can write through `const`, and the other
/// metrics read the same.
class EvaluationCopy {
 public:
  explicit EvaluationCopy(const metrics::Evaluation& original) : evaluation_(original) {
    metrics::Context& context = evaluation_.context;
    if (context.problem != nullptr) context.problem = &problem_.emplace(*context.problem);
    if (context.reference != nullptr) context.reference = &reference_.emplace(*context.reference);
    if (context.estimate != nullptr) context.estimate = &estimate_.emplace(*context.estimate);
    for (const auto& [pointer, copy] :
         {std::pair{&context.reference_covariances, &covariances_[0]},
          std::pair{&context.estimate_covariances, &covariances_[1]}}) {
      if (*pointer != nullptr) *pointer = &(*copy = **pointer);
    }
  }
  EvaluationCopy(const EvaluationCopy&) = delete;
  EvaluationCopy& operator=(const EvaluationCopy&) = delete;

  const metrics::Evaluation& evaluation() const { return evaluation_; }

 private:
  metrics::Evaluation evaluation_;
  std::optional<Problem> problem_;
  std::optional<Trajectory> reference_;
  std::optional<Trajectory> estimate_;
  std::array<std::vector<Matrix6>, 2> covariances_;
};

std::vector<metrics::Score> scores_of_metric(const metrics::MetricEntry& metric,
                                             const Params& options,
                                             const metrics::Evaluation& evaluation,
                                             const Sweep& sweep,
                                             const Catalogue& catalogue) {
  if (metric.name == kCommand) return command_scores(evaluation, command_options(options, sweep));
  if (plugin_version(catalogue, "metric", metric.name).empty()) {
    return metric.score(evaluation, options);
  }
  const FloatingPointGuard guard;
  const EvaluationCopy copy(evaluation);
  return metric.score(copy.evaluation(), options);
}

std::vector<ScoreResult> rows_of(const MetricChoice& choice,
                                 ScoreResult row,
                                 const metrics::Evaluation& evaluation,
                                 const Sweep& sweep,
                                 const Catalogue& catalogue) {
  std::vector<ScoreResult> out;
  row.metric = choice.metric.name;
  row.label = choice.label;
  row.coverage = evaluation.coverage;
  const metrics::MetricEntry& metric = find_metric(catalogue, choice.metric.name);
  const Activity activity("metric " + (row.label.empty() ? row.metric : row.label));
  catch_errors(row, [&] {
    std::vector<metrics::Score> scores =
        scores_of_metric(metric, choice.metric.options, evaluation, sweep, catalogue);
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

}  // namespace

void add_scores_of(CellResult& result,
                   const MetricChoice& choice,
                   const ScoreResult& row,
                   const metrics::Evaluation& evaluation,
                   const Sweep& sweep,
                   const Catalogue& catalogue) {
  std::ranges::move(rows_of(choice, row, evaluation, sweep, catalogue),
                    std::back_inserter(result.scores));
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
  std::vector<std::vector<ScoreResult>> scores(sweep.metrics.size());
  const auto evaluate = [&](std::size_t i) {
    scores[i] = rows_of(sweep.metrics[i], row, evaluation, sweep, catalogue);
  };
  if (parallel) {
    // The last first: in the default list, segments take the longest.
    parallel_for_tasks(scores.size(), [&](std::size_t i) { evaluate(scores.size() - 1 - i); });
  } else {
    for (std::size_t i = 0; i < scores.size(); ++i) evaluate(i);
  }
  for (std::vector<ScoreResult>& rows : scores) {
    std::ranges::move(rows, std::back_inserter(result.scores));
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
