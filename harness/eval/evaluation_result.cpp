#include "harness/eval/evaluation_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <map>
#include <stdexcept>
#include <utility>

#include "datasets/core/parallel.hpp"
#include "harness/execution/run/evaluation_notes.hpp"
#include "harness/execution/run/incomplete.hpp"
#include "metrics/checks/diagnostics.hpp"
#include "metrics/checks/extrinsic_offset.hpp"

namespace loopbench::harness {

std::vector<MetricRequest> default_metrics(const metrics::Protocol& protocol) {
  std::vector<MetricRequest> out;
  for (const metrics::MetricEntry& entry : metrics::metrics()) {
    if (entry.name == "rpe" && protocol.pairs == metrics::PairRule::tum_random) {
      out.push_back({entry.name, {}});
    } else if (entry.name == "rpe") {
      for (const char* unit : {"frames", "s", "m"}) {
        out.push_back({entry.name, {{"delta", 1.0}, {"unit", std::string(unit)}}});
      }
    } else if (entry.name == "segments" && protocol.segments == metrics::SegmentErrorRule{}) {
      out.push_back({entry.name, {{"each", false}}});
    } else if (entry.name == "ate" || entry.name == "axis_error" || entry.name == "segments") {
      out.push_back({entry.name, {}});
    }
  }
  return out;
}

bool has_no_number(const EvaluationResult& result) {
  return std::ranges::none_of(result.metrics, [](const EvaluatedMetric& metric) {
    return std::ranges::any_of(
        metric.scores, [](const metrics::Score& score) { return score.why_undefined.empty(); });
  });
}

namespace {

bool has_failed_metric(const EvaluationResult& result) {
  return std::ranges::any_of(
      result.metrics, [](const EvaluatedMetric& metric) { return !metric.why_failed.empty(); });
}

}  // namespace

std::string status(const EvaluationResult& result) {
  if (!result.why_failed.empty()) return "failed";
  if (has_no_number(result)) return has_failed_metric(result) ? "failed" : "undefined";
  return result.incomplete_reason.empty() ? "ok" : "incomplete";
}

void compare_coverage(std::vector<EvaluationResult>& results) {
  constexpr double kMuchLess = 0.5;
  const auto key = [](const EvaluationResult& result) {
    return result.reference + "\n" + result.protocol.label();
  };
  std::map<std::string, double> most;
  for (const EvaluationResult& result : results) {
    double& best = most[key(result)];
    best = std::max(best, result.coverage.least());
  }
  for (EvaluationResult& result : results) {
    const double best = most.at(key(result));
    if (!result.why_failed.empty() || !result.incomplete_reason.empty()) continue;
    if (result.coverage.least() >= kMuchLess * best) continue;
    result.incomplete_reason = fmt::format(
        "evaluated {} of {} poses over {:.1f} % of the reference's time, less than half of the "
        "{:.1f} % of another estimate",
        result.coverage.pairs,
        result.coverage.possible,
        100.0 * result.coverage.span,
        100.0 * best);
  }
}

std::string why_not_ok(const EvaluationResult& result) {
  if (!result.why_failed.empty()) return result.why_failed;
  if (!has_no_number(result)) return result.incomplete_reason;
  for (const EvaluatedMetric& metric : result.metrics) {
    if (!metric.why_failed.empty()) return metric.why_failed;
  }
  return "none of the requested metrics is defined";
}

namespace {

/// Sets diagnosis, notes and other_body.
void add_checks(EvaluationResult& out,
                const Trajectory& reference,
                const metrics::Evaluation& evaluation,
                const EvaluationOptions& options) {
  out.diagnosis = metrics::diagnostics(evaluation, {});
  out.notes = evaluation_notes(reference, evaluation);
  for (metrics::Score& score :
       out.diagnosis) {  // readers normalise, so use the value from the files
    if (score.relation == "off_unit")
      score = metrics::single("off_unit", "", "1", options.repaired.off_unit);
  }
  out.diagnosis.push_back(
      metrics::single("left_out", "", "1", static_cast<double>(options.repaired.repeated)));
  if (const auto offset = metrics::extrinsic_offset(evaluation, {})) {
    out.other_body = metrics::other_body(*offset, options.body_from_reference);
  }
}

EvaluatedMetric evaluated(const metrics::Evaluation& evaluation,
                          const metrics::MetricEntry& entry,
                          const MetricRequest& request) {
  EvaluatedMetric out{request.metric, request.options, {}, {}, {}};
  try {
    out.scores = entry.score(evaluation, request.options);
  } catch (const metrics::Undefined& reason) {
    out.why_undefined = reason.what();
  } catch (const std::runtime_error& error) {
    out.why_failed = error.what();
  }
  return out;
}

/// The requested metrics that exist; several at a time for many poses.
std::vector<EvaluatedMetric> evaluated(const metrics::Evaluation& evaluation,
                                       const std::vector<MetricRequest>& requests) {
  const std::vector<metrics::MetricEntry> known = metrics::metrics();
  std::vector<std::pair<const metrics::MetricEntry*, const MetricRequest*>> found;
  for (const MetricRequest& request : requests) {
    const auto entry = std::ranges::find(known, request.metric, &metrics::MetricEntry::name);
    if (entry != known.end()) found.emplace_back(&*entry, &request);
  }
  std::vector<EvaluatedMetric> out(found.size());
  const auto evaluate = [&](std::size_t i) {
    out[i] = evaluated(evaluation, *found[i].first, *found[i].second);
  };
  if (evaluation.estimate.size() >= kMinItemsPerThread) {
    // The last first: segments take the longest.
    parallel_for_tasks(found.size(), [&](std::size_t i) { evaluate(found.size() - 1 - i); });
  } else {
    for (std::size_t i = 0; i < found.size(); ++i) evaluate(i);
  }
  return out;
}

}  // namespace

EvaluationResult evaluate_estimate(const Trajectory& reference,
                                   const Trajectory& estimate,
                                   const metrics::NamedProtocol& protocol,
                                   const EvaluationOptions& options) {
  metrics::Evaluation evaluation = metrics::evaluate(reference, estimate, protocol.rules);
  evaluation.context = {.reference = &reference,
                        .estimate = &estimate,
                        .protocol = protocol.rules,
                        .printed = options.printed};
  EvaluationResult out;
  out.reference_poses = reference.size();
  out.estimate_poses = estimate.size();
  out.protocol = protocol;
  out.coverage = evaluation.coverage;
  out.incomplete_reason = incomplete_reason(evaluation.coverage, options.min_coverage);
  out.alignment = evaluation.alignment;
  const bool is_large = evaluation.estimate.size() >= kMinItemsPerThread;
  std::future<void> checks = std::async(is_large ? std::launch::async : std::launch::deferred,
                                        [&] { add_checks(out, reference, evaluation, options); });
  if (options.with_poses) out.poses = metrics::pose_errors(evaluation);
  if (options.with_figures) out.drawn = drawn_evaluation(reference, evaluation);
  out.metrics = evaluated(evaluation, options.metric_requests);
  checks.get();
  return out;
}

}  // namespace loopbench::harness
