/// Evaluation of two trajectory files without a sweep: computation and output of `eval`.
#pragma once

#include <string>
#include <vector>

#include "datasets/formats/formats.hpp"
#include "harness/eval/drawn_evaluation.hpp"
#include "harness/tables/table_view.hpp"
#include "metrics/errors/ape.hpp"
#include "metrics/protocols/protocols.hpp"

namespace loopbench::harness {

/// A metric with its options.
struct MetricRequest {
  std::string metric;
  Params options;  ///< options that differ from the metric's defaults
};

/// ate, axis_error and segments with their defaults (segments for each length if the protocol sets
/// the lengths), rpe over 1 frame, 1 s and 1 m (once for random pairs). Coverage and diagnostics
/// are reported above the table. Metrics that need more than two files, or that need options, are
/// available only in sweeps.
std::vector<MetricRequest> default_metrics(const metrics::Protocol& protocol);

struct EvaluationOptions {
  std::vector<MetricRequest> metric_requests;
  bool with_poses = false;
  bool with_figures = false;                       ///< keep the aligned poses
  double min_coverage = 0.0;                       ///< below it an evaluation is incomplete, 0..1
  const metrics::PrintedPoses* printed = nullptr;  ///< printed matrices if both files hold matrices
  ReadFindings repaired = {};                      ///< findings of the readers for both files
  Pose body_from_reference = {};                   ///< offset that was applied to the reference
};

struct EvaluatedMetric {
  std::string name;
  Params options;
  std::vector<metrics::Score> scores;
  std::string why_undefined;  ///< set instead of scores if the metric is undefined
  std::string why_failed;     ///< set instead of scores if the metric failed
};

struct EvaluationResult {
  std::string reference;
  std::string reference_body;  ///< body_from_reference as given; empty: identity
  std::string estimate;
  std::string reference_content;  ///< reference_content() and
  std::string content;            ///< pair_content(), to compare files; empty: unknown
  std::size_t reference_poses = 0;
  std::size_t estimate_poses = 0;
  metrics::NamedProtocol protocol;
  metrics::Coverage coverage;
  std::string incomplete_reason;  ///< set if coverage is below the limit; the scores remain
  metrics::Alignment alignment;
  std::vector<metrics::Score> diagnosis;  ///< metric `diagnostics` with its defaults
  std::string other_body;                 ///< set if the reference seems to track another body
  std::vector<std::string> notes;         ///< see evaluation_notes.hpp
  std::vector<EvaluatedMetric> metrics;
  std::vector<metrics::PoseError> poses;  ///< only on request
  DrawnEvaluation drawn;                  ///< only on request, without name
  std::string why_failed;  ///< set if the evaluation failed: only names and protocol are set
};

/// The evaluation failed, or no requested metric has a score.
bool has_no_number(const EvaluationResult& result);

/// ok, incomplete, undefined (all requested metrics are) or failed (the evaluation, or metrics
/// while no other has a score); and the reason if not ok.
std::string status(const EvaluationResult& result);
std::string why_not_ok(const EvaluationResult& result);

/// Uses the coverage limits of sweeps. Undefined and failed metrics are recorded with the
/// reason. Throws std::runtime_error if nothing can be evaluated.
EvaluationResult evaluate_estimate(const Trajectory& reference,
                                   const Trajectory& estimate,
                                   const metrics::NamedProtocol& protocol,
                                   const EvaluationOptions& options);

/// Marks an evaluation as incomplete if its coverage is less than half of that of another estimate
/// with the same reference and protocol, by the smaller of both shares.
void compare_coverage(std::vector<EvaluationResult>& results);

/// "rpe 1 s": short label of a metric and its options for a table column.
std::string label(const EvaluatedMetric& metric);

/// Text table with six decimals.
std::string text(const EvaluationResult& result);

/// The same in at most style.width columns, with four significant digits.
std::string terminal(const EvaluationResult& result, const TerminalStyle& style);

/// One table for each protocol, one row for each estimate: both coverage shares, and the protocol's
/// statistic of the combined errors (axis 3d or all), not of single axes or lengths. A metric with
/// its own pairs has their number in a column.
std::vector<Table> comparison(const std::vector<EvaluationResult>& results);

/// Array of objects, also for one evaluation; doubles in full precision. Keys: reference,
/// reference_body (if given), other_body (if detected), estimate, protocol {name, version,
/// changes, rules}, status (see above), why, pairs, possible, coverage (pairs / possible), span,
/// alignment {type, scale, rank, condition}, diagnosis {name: value}, notes [text], metrics
/// [{metric, options, relation, axis, unit, rmse, mean, median, std, min, max, count}], undefined
/// [{metric, options, why}], with relation and axis if only one score of a metric is undefined,
/// failed [{metric, options, why}]. Failed evaluations have empty metrics, undefined and failed.
std::string json(const std::vector<EvaluationResult>& results);

/// One line per score or failure, or one line per pose; doubles in full precision.
std::string csv(const std::vector<EvaluationResult>& results);
std::string pose_csv(const std::vector<EvaluationResult>& results);

}  // namespace loopbench::harness
