#include "harness/eval/recorded_evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <iterator>
#include <memory>
#include <utility>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/core/parallel.hpp"
#include "harness/eval/recordings.hpp"
#include "harness/model/recorded_run.hpp"
#include "harness/run/add_scores.hpp"
#include "harness/run/catch_errors.hpp"
#include "harness/run/doctor_notes.hpp"
#include "harness/run/evaluation_notes.hpp"
#include "harness/run/sequence_identity.hpp"
#include "harness/run/summarise_sequence.hpp"
#include "metrics/checks/diagnostics.hpp"
#include "metrics/checks/extrinsic_offset.hpp"

namespace loopbench::harness {
namespace {

/// `option`: of the dataset, by which the gate finds the reference among the inputs.
InputFile hashed_input(const std::string& name, const std::string& option) {
  return hashed_inputs({{file_of(name), option}}).front();
}

std::string option(const Cell& cell, const Sweep& sweep, const std::string& name) {
  return to_text(sweep.datasets[cell.dataset].dataset.options.at(name));
}

/// Identity of the run, also if the estimate could not be read: whether two failures are copies,
/// and whether the file has changed since, is decided as for other runs.
SequenceMetadata metadata_of(const Cell& cell,
                             const Sweep& sweep,
                             const SharedReference& reference) {
  SequenceMetadata out;
  out.size.reference = static_cast<std::int64_t>(reference.read.poses.size());
  if (reference.content.empty()) return out;
  const std::string stated = option(cell, sweep, "group");
  out.group = recorded_group(option(cell, sweep, "run"),
                             !stated.empty()               ? "group:" + stated
                             : reference.recording.empty() ? "reference:" + reference.content
                                                           : "reference:" + reference.recording);
  if (!reference.file) return out;
  out.source = "reference:" + reference.content;
  out.inputs = {*reference.file, hashed_input(option(cell, sweep, "estimate"), "estimate")};
  return out;
}

std::shared_ptr<const SequenceMetadata> metadata_of_failure(const Cell& cell,
                                                            const Sweep& sweep,
                                                            const SharedReference& reference) {
  if (reference.content.empty()) return nullptr;
  try {
    SequenceMetadata out = metadata_of(cell, sweep, reference);
    const std::string hash = hashed_input(option(cell, sweep, "estimate"), "estimate").hash;
    out.content = Fields().add("unreadable").add(reference.content).add(hash).hashed();
    return std::make_shared<const SequenceMetadata>(std::move(out));
  } catch (const InputError&) {
    return nullptr;  // the file exists, but cannot be hashed either
  }
}

/// Adds content and, for a store, the trace.
void identify(SequenceMetadata& out,
              const SharedReference& reference,
              const RecordedFile& estimate) {
  out.size.keyframes = static_cast<std::int64_t>(estimate.poses.size());
  if (reference.content.empty()) return;
  Sequence sequence;
  sequence.reference = reference.read.poses;
  sequence.problem.keyframes = estimate.poses;
  out.content = content_of(sequence);
  if (reference.file) out.trace = sequence_trace(sequence);
}

/// Error if only one file has stamps, since numbers and stamps would be paired by chance.
std::string why_two_clocks(const EvalArguments& a,
                           const metrics::Protocol& protocol,
                           const std::string& one,
                           const std::string& other) {
  const bool uses_stamps = protocol.association != metrics::Association::index;
  if (a.period || !uses_stamps || one.empty() == other.empty()) return "";
  return one + other +
         ", poses without stamps, and the other file has stamps: expected --times FILE (KITTI), "
         "--period S or --association index";
}

/// Sets diagnosis, notes and other_body.
void add_checks(EvaluationResult& out,
                const metrics::Evaluation& evaluation,
                const RecordedFile& reference,
                const RecordedFile& estimate,
                const EvalArguments& a) {
  out.diagnosis = metrics::diagnostics(evaluation, {});
  out.notes = evaluation_notes(reference.poses, evaluation);
  const double off_unit = std::max(reference.findings.off_unit, estimate.findings.off_unit);
  for (metrics::Score& score : out.diagnosis) {
    // Readers normalise, so the value is that of the files.
    if (score.relation == "off_unit") score = metrics::single("off_unit", "", "1", off_unit);
  }
  const std::size_t left_out = reference.findings.repeated + estimate.findings.repeated;
  out.diagnosis.push_back(metrics::single("left_out", "", "1", static_cast<double>(left_out)));
  if (const auto offset = metrics::extrinsic_offset(evaluation, {})) {
    out.other_body = metrics::other_body(*offset, pose_of(reference_body(a)));
  }
}

std::string common_times_note(const Trajectory& estimate, const std::string& common) {
  const std::size_t kept = poses_within(estimate, common).size();
  return fmt::format(
      "evaluated over the times that all estimates of the sequence cover: {} of {} poses are left "
      "out (--common no evaluates all)",
      estimate.size() - kept,
      estimate.size());
}

/// Evaluation of two files under the protocols of a sweep, one after the other.
struct PairEvaluation {
  const Sweep& sweep;
  const RecordedFile& reference;
  const RecordedFile& estimate;
  const Catalogue& catalogue;
  const EvalArguments& arguments;
  EvaluatedFile& out;
  std::string common;  ///< times to evaluate; empty: all

  void evaluate(std::size_t number) {
    EvaluationResult& own = out.protocols[number];
    const metrics::Protocol& rules = own.protocol.rules;
    ScoreResult row;
    row.protocol = number;
    ScoreResult failure = row;
    failure.why = why_two_clocks(arguments, rules, reference.unstamped, estimate.unstamped);
    if (!failure.why.empty()) {
      failure.status = Status::failed;
    } else {
      catch_errors(failure, [&] { add(own, row, rules); });
    }
    if (failure.status == Status::ok) return;
    own.why_failed = failure.why;
    add_failure(out.result, failure, sweep);
  }

 private:
  /// The errors at these times, with the coverage of all.
  metrics::Evaluation within_common_times(const metrics::Evaluation& all,
                                          const metrics::Protocol& rules) const {
    metrics::Evaluation part =
        metrics::evaluate(reference.poses, poses_within(estimate.poses, common), rules);
    part.coverage = all.coverage;
    return part;
  }

  void add(EvaluationResult& own, const ScoreResult& row, const metrics::Protocol& rules) {
    metrics::Evaluation evaluation = metrics::evaluate(reference.poses, estimate.poses, rules);
    if (!common.empty()) evaluation = within_common_times(evaluation, rules);
    const bool are_printed = !reference.matrices.empty() && !estimate.matrices.empty();
    metrics::PrintedPoses printed;
    if (are_printed) printed = {reference.matrices, estimate.matrices};
    evaluation.context = {.reference = &reference.poses,
                          .estimate = &estimate.poses,
                          .protocol = rules,
                          .printed = are_printed ? &printed : nullptr};
    own.reference_poses = reference.poses.size();
    own.estimate_poses = estimate.poses.size();
    own.coverage = evaluation.coverage;
    own.alignment = evaluation.alignment;
    own.incomplete_reason = incomplete_reason(evaluation.coverage, sweep.min_coverage);
    const bool is_large = evaluation.estimate.size() >= kMinItemsPerThread;
    std::future<void> checks =
        std::async(is_large ? std::launch::async : std::launch::deferred,
                   [&] { add_checks(own, evaluation, reference, estimate, arguments); });
    if (!arguments.per_pose.empty()) own.poses = metrics::pose_errors(evaluation);
    if (!arguments.plot.empty() || !arguments.report.empty()) {
      own.drawn = drawn_evaluation(reference.poses, evaluation);
    }
    add_scores(out.result, row, evaluation, sweep, catalogue, is_large);
    if (!arguments.store.empty() && row.protocol == 0) {
      const StampedPose& first = reference.poses.front();
      const Vector3& p = first.world_from_body.translation;
      out.result.trace = cell_trace(evaluation, row.times, {first.stamp, p.x(), p.y(), p.z()});
    }
    checks.get();
  }
};

/// Without results.
EvaluatedFile not_evaluated(const Cell& cell, const Sweep& sweep, const EvalArguments& a) {
  EvaluatedFile out;
  out.result.cell = cell;
  for (const metrics::NamedProtocol& protocol : sweep.protocols) {
    EvaluationResult& own = out.protocols.emplace_back();
    own.reference = option(cell, sweep, "reference");
    own.reference_body = a.reference_body.value_or("");
    own.estimate = option(cell, sweep, "estimate");
    own.protocol = protocol;
  }
  return out;
}

}  // namespace

SharedReference shared_reference(const Params& options,
                                 const Sweep& sweep,
                                 const EvalArguments& a) {
  SharedReference out{recorded_reference(options, uses_digits(sweep, a))};
  if (!a.store.empty()) out.file = hashed_input(to_text(options.at("reference")), "reference");
  if (!a.store.empty() || sweep.datasets.size() > 1) {
    Sequence sequence;
    sequence.reference = out.read.poses;
    out.content = content_of(sequence);
  }
  return out;
}

EvaluatedFile evaluate_poses(const Cell& cell,
                             const Sweep& sweep,
                             const SharedReference& reference,
                             RecordedFile estimate,
                             const Catalogue& catalogue,
                             const EvalArguments& a) {
  EvaluatedFile out = not_evaluated(cell, sweep, a);
  SequenceMetadata metadata = metadata_of(cell, sweep, reference);
  identify(metadata, reference, estimate);
  const bool is_large = estimate.poses.size() >= kMinItemsPerThread;
  std::future<std::vector<std::string>> doctor =
      std::async(is_large ? std::launch::async : std::launch::deferred, [&] {
        const bool has_stamps = reference.read.unstamped.empty() && estimate.unstamped.empty();
        return doctor_notes({reference.read.poses,
                             estimate.poses,
                             option(cell, sweep, "reference"),
                             option(cell, sweep, "estimate"),
                             has_stamps},
                            sweep.protocols);
      });
  const std::string common = option(cell, sweep, "common");
  if (!common.empty()) metadata.notes.push_back(common_times_note(estimate.poses, common));
  PairEvaluation evaluation{sweep, reference.read, estimate, catalogue, a, out, common};
  for (std::size_t p = 0; p < sweep.protocols.size(); ++p) evaluation.evaluate(p);
  for (const RecordedFile* file : {&reference.read, &std::as_const(estimate)}) {
    if (!file->findings.damage.empty())
      metadata.notes.push_back("damaged file: " + file->findings.damage);
  }
  std::ranges::move(doctor.get(), std::back_inserter(metadata.notes));
  const std::vector<std::string> of_files = metadata.notes;
  for (EvaluationResult& own : out.protocols) {
    if (!own.why_failed.empty()) continue;
    for (const std::string& note : own.notes) {
      if (std::ranges::count(metadata.notes, note) == 0) metadata.notes.push_back(note);
    }
    own.notes.insert(own.notes.end(), of_files.begin(), of_files.end());
  }
  out.result.metadata = std::make_shared<const SequenceMetadata>(std::move(metadata));
  return out;
}

EvaluatedFile evaluate_recorded(const Cell& cell,
                                const Sweep& sweep,
                                const SharedReference& reference,
                                const Catalogue& catalogue,
                                const EvalArguments& a) {
  try {
    const Params& options = sweep.datasets[cell.dataset].dataset.options;
    return evaluate_poses(
        cell, sweep, reference, recorded_estimate(options, uses_digits(sweep, a)), catalogue, a);
  } catch (const InputError& error) {
    EvaluatedFile out = not_evaluated(cell, sweep, a);
    out.result.status = Status::failed;
    out.result.why = error.what();
    out.result.metadata = metadata_of_failure(cell, sweep, reference);
    for (EvaluationResult& own : out.protocols) own.why_failed = error.what();
    return out;
  }
}

}  // namespace loopbench::harness
