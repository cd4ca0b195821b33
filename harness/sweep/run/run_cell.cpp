#include "harness/sweep/run/run_cell.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "datasets/core/closure_places.hpp"
#include "harness/sweep/catalogue/external_methods.hpp"
#include "harness/sweep/catalogue/floating_point_guard.hpp"
#include "harness/sweep/catalogue/server.hpp"
#include "harness/sweep/run/add_scores.hpp"
#include "harness/sweep/run/check_output.hpp"
#include "harness/sweep/run/estimate_files.hpp"
#include "harness/sweep/run/summarise_sequence.hpp"
#include "harness/sweep/run/timed_runs.hpp"
#include "metrics/trajectory/tracking_gaps.hpp"

namespace loopbench::harness {
namespace {

/// An estimate as a method returns it.
struct Estimate {
  const Curve& curve;
  const std::vector<Matrix6>& covariances;  ///< one per keyframe; empty: none stated
  const std::optional<std::vector<std::size_t>>& rejected;  ///< closures
  const metrics::SolveWithout& without;
};

/// The result of the method without some closures, as a metric asks for it.
Trajectory solved_without(const methods::Estimator& method,
                          const Problem& all,
                          const std::vector<std::size_t>& closures) {
  const Problem problem = without_closures(all, closures);
  const std::string why = reason_to_decline(method, problem);
  if (!why.empty()) throw metrics::Undefined("without the closures of a place: " + why);
  const FloatingPointGuard guard;
  end_servers();  // no answer is from the memory of a program
  methods::Report report;
  const std::unique_ptr<const Curve> curve = method.estimate(problem, report);
  check_span(curve.get(), problem.keyframes);
  return CheckedCurve(*curve).sample(stamps(problem.keyframes));
}

metrics::Context context_of(const Sequence& sequence,
                            const Trajectory& at_keyframes,
                            const Estimate& estimate,
                            metrics::Times times,
                            const metrics::Protocol& protocol) {
  return {.reference = &sequence.reference,
          .estimate = &at_keyframes,
          .problem = &sequence.problem,
          .curve = &estimate.curve,
          .times = times,
          .protocol = protocol,
          .loop_candidates = &sequence.loop_candidates,
          .estimate_covariances = estimate.covariances.empty() ? nullptr : &estimate.covariances,
          .solve_without = &estimate.without,
          .false_closures = sequence.false_closures ? &*sequence.false_closures : nullptr,
          .rejected_closures = estimate.rejected ? &*estimate.rejected : nullptr};
}

/// Whether all positions are equal to within 1e-9 of the reference's largest distance from its
/// first one. False for fewer than three poses, and for a reference at rest. O(n).
bool has_equal_positions(const Trajectory& estimate, const Trajectory& reference) {
  constexpr double kTolerance = 1e-9;  // of the size
  if (reference.size() < 3 || reference.size() != estimate.size()) return false;
  double size = 0.0;
  double difference = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const auto& position = reference[i].world_from_body.translation;
    size = std::max(size, (position - reference.front().world_from_body.translation).norm());
    difference = std::max(difference, (estimate[i].world_from_body.translation - position).norm());
  }
  return size > 0.0 && difference <= kTolerance * size;
}

/// Computes every metric under the protocol and times of `row`.
void evaluate_curve(CellResult& result,
                    const ScoreResult& row,
                    const Sweep& sweep,
                    const Sequence& sequence,
                    const Estimate& estimate,
                    const Catalogue& catalogue) {
  const std::vector<double> keyframe_stamps = stamps(sequence.problem.keyframes);
  const Curve& curve = estimate.curve;
  const Trajectory at_keyframes = curve.sample(keyframe_stamps);
  const std::vector<double> tracked = metrics::tracked_stamps(sequence.problem);
  const metrics::Protocol& protocol = sweep.protocols[row.protocol].rules;
  ScoreResult failure = row;
  catch_errors(failure, [&] {
    metrics::Evaluation evaluation =
        metrics::evaluate(sequence.reference, curve, keyframe_stamps, row.times, protocol, tracked);
    evaluation.context = context_of(sequence, at_keyframes, estimate, row.times, protocol);
    // Noise-free data equal the reference without any method.
    const bool has_moved = !has_equal_positions(at_keyframes, sequence.problem.keyframes);
    if (!result.oracle_method && has_moved &&
        has_equal_positions(evaluation.estimate, evaluation.reference)) {
      result.oracle_method = true;
      result.notes.push_back({.kind = NoteKind::oracle,
                              .severity = Severity::decisive,
                              .detail = "the result equals the reference"});
    }
    add_scores(result, row, evaluation, sweep, catalogue);
    const bool densest = row.times == metrics::Times::dense ||
                         std::ranges::count(sweep.times, metrics::Times::dense) == 0;
    if (sweep.traces && row.protocol == 0 && densest) {
      result.trace =
          cell_trace(evaluation, row.times, trace_origin(sequence), pose_values(result, row));
    }
  });
  // No pairs, or no unique alignment.
  if (failure.status != Status::ok) add_failure(result, failure, sweep);
}

/// Computes metrics that need only the problem; once, since they depend on neither pairs nor times.
void add_scores_without_reference(CellResult& result,
                                  const Sweep& sweep,
                                  const Sequence& sequence,
                                  const Estimate& estimate,
                                  const Catalogue& catalogue) {
  const Trajectory at_keyframes = estimate.curve.sample(stamps(sequence.problem.keyframes));
  for (std::size_t p = 0; p < sweep.protocols.size(); ++p) {
    metrics::Evaluation evaluation;
    evaluation.protocol = sweep.protocols[p].rules;
    evaluation.context = context_of(
        sequence, at_keyframes, estimate, metrics::Times::keyframes, evaluation.protocol);
    const ScoreResult row{p, metrics::Times::keyframes, "", "", {}, {}, Status::ok, ""};
    for (const MetricChoice& choice : sweep.metrics) {
      if (find_metric(catalogue, choice.metric.name).needs_reference) continue;
      add_scores_of(result, choice, row, evaluation, sweep, catalogue);
    }
  }
}

}  // namespace

CellResult run_cell(const Cell& cell,
                    const Sweep& sweep,
                    const Sequence& sequence,
                    const Catalogue& catalogue) {
  if (const auto own = with_alignment_of(cell.dataset, sweep)) {
    return run_cell(cell, *own, sequence, catalogue);
  }
  forget_estimate(cell);
  CellResult result;
  result.cell = cell;
  const MethodChoice& choice = sweep.methods[cell.method];
  result.oracle_method = uses_reference(choice, catalogue);
  catch_errors(result, [&] {
    if (result.oracle_method && lacks_rotations(sequence.reference)) {
      result.status = Status::declined;
      result.why = "reads the reference, which has positions without rotation";
      return;
    }
    const auto method = make_method(choice, catalogue, sequence.reference, sweep);
    if (const std::string why = reason_to_decline(*method, sequence.problem); !why.empty()) {
      result.status = Status::declined;
      result.why = stored_reason(why);
      return;
    }
    const bool is_foreign = std::ranges::any_of(choice.stages, [&](const Choice& stage) {
      return !plugin_version(catalogue, "method", stage.name).empty();
    });
    // The method of a plugin can write through `const`, and metrics read the same.
    const Problem copy = is_foreign ? sequence.problem : Problem{};
    const std::unique_ptr<const Curve> curve =
        timed(result, *method, is_foreign ? copy : sequence.problem, sweep);
    check_span(curve.get(), sequence.problem.keyframes);
    const CheckedCurve checked(*curve);
    // Only metrics read them: they are neither sent to the sweep nor stored.
    const std::vector<Matrix6> covariances = std::exchange(result.report.covariances, {});
    check_covariances(covariances, sequence.problem.keyframes.size());
    check_rejected(result.report.rejected, sequence.problem.closures.size());
    std::map<std::vector<std::size_t>, Trajectory> solved;  // asked for under every protocol
    const metrics::SolveWithout without = [&](const std::vector<std::size_t>& closures) {
      auto found = solved.find(closures);
      if (found == solved.end()) {
        found = solved.emplace(closures, solved_without(*method, sequence.problem, closures)).first;
      }
      return found->second;
    };
    const Estimate estimate{checked, covariances, result.report.rejected, without};
    save_estimate(cell, sweep, sequence, checked);
    if (sequence.reference.empty()) {
      result.why = "no reference to evaluate against";
      add_scores_without_reference(result, sweep, sequence, estimate, catalogue);
      checked.require_valid_so_far();
      return;
    }
    for (std::size_t p = 0; p < sweep.protocols.size(); ++p) {
      for (const metrics::Times times : sweep.times) {
        const ScoreResult row{p, times, "", "", {}, {}, Status::ok, ""};
        evaluate_curve(result, row, sweep, sequence, estimate, catalogue);
      }
    }
    checked.require_valid_so_far();
  });
  if (is_failure(result.status)) {  // scores of an invalid curve have no meaning
    result.scores.clear();
    result.trace = {};
  }
  return result;
}

}  // namespace loopbench::harness
