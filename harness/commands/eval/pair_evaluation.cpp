#include "harness/commands/eval/pair_evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <optional>

#include "datasets/core/parallel.hpp"
#include "harness/commands/eval/common_parts.hpp"
#include "harness/commands/eval/common_rows.hpp"
#include "harness/commands/eval/eval_figures.hpp"
#include "harness/commands/eval/evaluation_checks.hpp"
#include "harness/commands/eval/pairing_remedies.hpp"
#include "harness/sweep/run/add_scores.hpp"
#include "harness/sweep/run/check_output.hpp"

namespace loopbench::harness {
namespace {

const std::vector<Matrix6>* unless_empty(const std::vector<Matrix6>& covariances) {
  return covariances.empty() ? nullptr : &covariances;
}

/// Of positions with the stated standard deviation per axis [m]; 0: none.
std::vector<Matrix6> stated_covariances(std::size_t poses, double sigma) {
  if (!(sigma > 0.0)) return {};
  Matrix6 each = Matrix6::Zero();
  each.topLeftCorner<3, 3>().diagonal().setConstant(sigma * sigma);
  return std::vector<Matrix6>(poses, each);
}

struct PairEvaluation {
  const EvaluatedSweep& files;
  const EvaluatedFile& reference;
  const EvaluatedFile& estimate;
  FileEvaluation& out;
  std::string common;
  /// Poses of the estimate that are possible pairs; none: as the evaluation counts them.
  std::optional<std::size_t> possible = {};

  void evaluate(std::size_t number) {
    EvaluationResult& own = out.protocols[number];
    const metrics::Protocol& rules = own.protocol.rules;
    ScoreResult row;
    row.protocol = number;
    ScoreResult failure = row;
    failure.why = why_two_clocks(files.arguments, rules, reference.clock, estimate.clock);
    if (!failure.why.empty()) {
      failure.status = Status::failed;
      own.names_files = true;
    } else {
      catch_errors(failure, [&] { add_paired(own, row, rules); });
      if (is_failure(failure.status)) failure.why += remedy(rules);
    }
    if (failure.status == Status::ok) return;
    own.why_failed = failure.why;
    add_failure(out.result, failure, files.sweep);
  }

 private:
  /// What pairs poses of files that the rules do not pair; empty: nothing.
  std::string remedy(const metrics::Protocol& rules) const {
    if (rules.association != metrics::Association::index)
      return remedies_without_pairs(reference.poses, estimate.poses, rules);
    const bool have_stamps =
        reference.clock.clock == Clock::stamps && estimate.clock.clock == Clock::stamps;
    if (!have_stamps || reference.clock.rows == estimate.clock.rows) return {};
    return "; --association nearest pairs them by their stamps";
  }

  /// The errors at these times, with the coverage of all.
  metrics::Evaluation within_common_times(const metrics::Evaluation& all) const {
    metrics::Evaluation part =
        metrics::evaluate(reference.poses, poses_within(estimate.poses, common), all.protocol);
    part.coverage = all.coverage;
    return part;
  }

  /// Only poses in the time range are possible pairs. As in evo, only the reference is cut, so that
  /// poses at the ends keep their partners.
  void count_in_range(metrics::Coverage& coverage, double offset) const {
    const EvaluatedRange range = evaluated_range(files.arguments);
    const auto count = std::ranges::count_if(estimate.poses, [&](const StampedPose& pose) {
      return pose.stamp + offset >= range.start && pose.stamp + offset <= range.end;
    });
    coverage.possible = std::max(coverage.pairs, static_cast<std::size_t>(count));
  }

  /// By index, poses of the same row are paired: rows keep their numbers if others are dropped.
  void add_paired(EvaluationResult& own, const ScoreResult& row, const metrics::Protocol& rules) {
    const bool by_index = rules.association == metrics::Association::index;
    const bool is_complete = reference.rows.empty() && estimate.rows.empty();
    if (!by_index || is_complete) return add(own, row, rules);
    if (reference.clock.rows != estimate.clock.rows) {
      throw InputError(
          fmt::format("association index: the reference has {} rows and the estimate {}, expected "
                      "equal numbers",
                      reference.clock.rows,
                      estimate.clock.rows));
    }
    const auto [a, b] = with_common_rows(reference, estimate);
    PairEvaluation part{files, a, b, out, common, rows_in_range(reference, estimate)};
    part.add(own, row, rules);
    own.reference_poses = reference.poses.size();
    own.estimate_poses = estimate.poses.size();
  }

  void add(EvaluationResult& own, const ScoreResult& row, const metrics::Protocol& rules) {
    const EvalArguments& arguments = files.arguments;
    const Sweep& sweep = files.sweep;
    metrics::Evaluation evaluation = metrics::evaluate(reference.poses, estimate.poses, rules);
    if (!common.empty()) evaluation = within_common_times(evaluation);
    if (possible) {
      evaluation.coverage.possible = *possible;
    } else if (arguments.start || arguments.end) {
      count_in_range(evaluation.coverage, rules.offset);
    }
    const bool are_printed = !reference.matrices.empty() && !estimate.matrices.empty();
    const std::vector<Matrix6>& read = reference.findings.covariances;
    const std::vector<Matrix6> of_reference =
        read.empty() ? stated_covariances(reference.poses.size(), arguments.reference_sigma) : read;
    metrics::PrintedPoses printed;
    if (are_printed) printed = {reference.matrices, estimate.matrices};
    evaluation.context = {.reference = &reference.poses,
                          .estimate = &estimate.poses,
                          .protocol = rules,
                          .printed = are_printed ? &printed : nullptr,
                          .reference_covariances = unless_empty(of_reference),
                          .estimate_covariances = unless_empty(estimate.findings.covariances)};
    own.reference_poses = reference.poses.size();
    own.estimate_poses = estimate.poses.size();
    own.coverage = evaluation.coverage;
    own.alignment = evaluation.alignment;
    own.incomplete_reason = incomplete_reason(evaluation.coverage, sweep.min_coverage);
    const bool is_large = evaluation.estimate.size() >= kMinItemsPerThread;
    std::future<void> checks =
        std::async(is_large ? std::launch::async : std::launch::deferred, [&] {
          if (!arguments.diagnose) return;
          add_checks(own, evaluation, reference, estimate, files);
        });
    if (arguments.pose_errors || !arguments.per_pose.empty())
      own.poses = metrics::pose_errors(evaluation);
    if (!arguments.plot.empty()) own.drawn = drawn_evaluation(reference.poses, evaluation);
    add_scores(out.result, row, evaluation, sweep, files.catalogue, is_large);
    if (!own.poses.empty()) own.pose_values = pose_values(out.result, row);
    if (files.arguments.keeps_traces() && row.protocol == 0) {
      const StampedPose& first = reference.poses.front();
      const Vector3& p = first.world_from_body.translation;
      out.result.trace = cell_trace(
          evaluation, row.times, {first.stamp, p.x(), p.y(), p.z()}, pose_values(out.result, row));
    }
    checks.get();
    note_missing_segments(own, row.protocol);
  }

  /// A protocol with lengths of its own has a column for them, unless the path is too short.
  void note_missing_segments(EvaluationResult& own, std::size_t protocol) const {
    if (own.protocol.rules.segments == metrics::SegmentErrorRule{}) return;
    for (const ScoreResult& each : out.result.scores) {
      const bool is_missing = each.protocol == protocol && each.status == Status::declined;
      if (!is_missing || each.metric != "segments") continue;
      own.notes.push_back(
          {.kind = NoteKind::undefined, .subject = each.metric, .detail = each.why});
    }
  }
};

}  // namespace

void evaluate_pair(const EvaluatedPair& pair, FileEvaluation& out) {
  PairEvaluation evaluation{pair.files, pair.reference, pair.estimate, out, pair.common};
  for (std::size_t p = 0; p < out.protocols.size(); ++p) evaluation.evaluate(p);
}

}  // namespace loopbench::harness
