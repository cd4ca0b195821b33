#include "harness/commands/eval/file_evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <iterator>
#include <memory>
#include <optional>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/core/parallel.hpp"
#include "harness/commands/eval/common_parts.hpp"
#include "harness/commands/eval/common_rows.hpp"
#include "harness/commands/eval/eval_figures.hpp"
#include "harness/commands/eval/evaluation_checks.hpp"
#include "harness/commands/eval/pairing_remedies.hpp"
#include "harness/sweep/model/evaluated_run.hpp"
#include "harness/sweep/model/note_text.hpp"
#include "harness/sweep/run/add_scores.hpp"
#include "harness/sweep/run/check_output.hpp"
#include "harness/sweep/run/evaluation_notes.hpp"
#include "harness/sweep/run/summarise_sequence.hpp"

namespace loopbench::harness {
namespace {

/// `option`: of the dataset, by which the gate finds the reference among the inputs. Throws
/// InputError.
InputFile hashed_input(const std::string& name, const std::string& option) {
  return hashed_inputs({{file_of(name), option}}).front();
}

/// Identity of the run, also if the estimate could not be read (null): whether two failures are
/// copies, and whether the file has changed since, is decided as for other runs. Throws InputError.
SequenceMetadata metadata_of(const EvaluatedRun& run,
                             const SharedReference& reference,
                             const EvaluatedFile* estimate) {
  SequenceMetadata out;
  out.size.reference = static_cast<std::int64_t>(reference.read.poses.size());
  if (estimate) out.size.keyframes = static_cast<std::int64_t>(estimate->poses.size());
  if (reference.content.empty()) return out;
  out.group = evaluated_group(
      run.run, run.group.empty() ? "reference:" + reference.content : "group:" + run.group);
  if (reference.file) {
    out.source = "reference:" + reference.content;
    out.inputs = {*reference.file, hashed_input(run.estimate, "estimate")};
  }
  if (!estimate) {
    const std::string hash = hashed_input(run.estimate, "estimate").hash;
    out.content = Fields().add("unreadable").add(reference.content).add(hash).hashed();
    return out;
  }
  Sequence sequence;
  sequence.reference = reference.read.poses;
  sequence.problem.keyframes = estimate->poses;
  out.content = content_of(sequence);
  if (reference.is_traced) out.trace = sequence_trace(sequence);
  return out;
}

Note common_times_note(const Trajectory& estimate, const std::string& common) {
  const std::size_t kept = poses_within(estimate, common).size();
  return {.kind = NoteKind::common_times,
          .numbers = {{"left out", static_cast<double>(estimate.size() - kept)},
                      {"poses", static_cast<double>(estimate.size())}},
          .remedy = {"--common", "no"}};
}

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

/// Evaluation of two files under the protocols of a sweep, one after the other.
struct PairEvaluation {
  const EvaluatedSweep& files;
  const EvaluatedFile& reference;
  const EvaluatedFile& estimate;
  FileEvaluation& out;
  std::string common;  ///< times to evaluate; empty: all
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
    } else {
      catch_errors(failure, [&] { add_paired(own, row, rules); });
    }
    if (own.coverage.pairs == 0 && failure.why.starts_with("no pose of the estimate")) {
      failure.why += pairing_remedies(reference.poses, estimate.poses, rules);
    }
    const bool have_stamps =
        reference.clock.clock == Clock::stamps && estimate.clock.clock == Clock::stamps;
    if (have_stamps && failure.why.starts_with("association index: the reference has")) {
      failure.why += "; --association nearest pairs them by their stamps";
    }
    if (failure.status == Status::ok) return;
    own.why_failed = failure.why;
    add_failure(out.result, failure, files.sweep);
  }

 private:
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
      out.result.trace = cell_trace(evaluation, row.times, {first.stamp, p.x(), p.y(), p.z()});
      add_pose_values(out.result, row);
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

/// Without results.
FileEvaluation not_evaluated(const Cell& cell, const EvaluatedSweep& files) {
  FileEvaluation out;
  out.result.cell = cell;
  for (const metrics::NamedProtocol& protocol : files.sweep.protocols) {
    EvaluationResult& own = out.protocols.emplace_back();
    own.reference = files.runs[cell.dataset].reference;
    own.reference_body = files.arguments.reference_body.value_or("");
    own.estimate = files.runs[cell.dataset].estimate;
    own.protocol = protocol;
  }
  return out;
}

/// Notes of the evaluations belong to the cell, those of the files to every evaluation; a failed
/// one states what the doctor found, which can be why.
void share_notes(std::vector<EvaluationResult>& evaluations, std::vector<Note>& of_cell) {
  const std::vector<Note> of_files = of_cell;
  for (EvaluationResult& own : evaluations) {
    if (!own.why_failed.empty()) {
      for (const Note& note : of_files) {
        // The error states both ranges itself.
        const bool is_known =
            note.kind == NoteKind::no_overlap && note.number("frame numbers") == 0.0;
        if (is_of_doctor(note.kind) && !is_known) own.why_failed += "; " + text(note);
      }
      continue;
    }
    for (const Note& note : own.notes) {
      if (std::ranges::count(of_cell, note) == 0) of_cell.push_back(note);
    }
    own.notes.insert(own.notes.end(), of_files.begin(), of_files.end());
    if (std::ranges::any_of(of_files, explains_other_body)) own.other_body.clear();
  }
}

}  // namespace

SharedReference shared_reference(const std::string& file, const EvaluatedSweep& files) {
  const EvalArguments& a = files.arguments;
  const auto run = std::ranges::find(files.runs, file, &EvaluatedRun::reference);
  const std::string estimate = run == files.runs.end() ? std::string() : run->estimate;
  SharedReference out{evaluated_reference(file, a, files.has_digits, estimate)};
  out.is_traced = a.keeps_traces();
  if (!a.store.empty()) out.file = hashed_input(file, "reference");
  if (out.is_traced || files.runs.size() > 1) {
    Sequence sequence;
    sequence.reference = out.read.poses;
    out.content = content_of(sequence);
  }
  return out;
}

FileEvaluation evaluate_poses(const Cell& cell,
                              const EvaluatedSweep& files,
                              const SharedReference& reference,
                              const EvaluatedFile& estimate) {
  const EvaluatedRun& run = files.runs[cell.dataset];
  FileEvaluation out = not_evaluated(cell, files);
  SequenceMetadata metadata = metadata_of(run, reference, &estimate);
  const bool is_large = estimate.poses.size() >= kMinItemsPerThread;
  std::future<std::vector<Note>> doctor =
      std::async(is_large ? std::launch::async : std::launch::deferred, [&] {
        if (!files.arguments.diagnose) return std::vector<Note>{};
        const bool pairs_rows = std::ranges::all_of(files.sweep.protocols, [](const auto& each) {
          return each.rules.association == metrics::Association::index;
        });
        // Rows of unequal numbers are no pairs: the stamps tell more.
        const bool by_index = pairs_rows && reference.read.clock.rows == estimate.clock.rows;
        const bool has_stamps = !by_index && reference.read.clock.clock == Clock::stamps &&
                                estimate.clock.clock == Clock::stamps;
        Trajectory kept_reference, kept_estimate;
        return doctor_notes({for_doctor(reference.read, by_index, kept_reference),
                             for_doctor(estimate, by_index, kept_estimate),
                             run.reference,
                             run.estimate,
                             has_stamps},
                            files.sweep.protocols);
      });
  if (!run.common.empty()) metadata.notes.push_back(common_times_note(estimate.poses, run.common));
  PairEvaluation evaluation{files, reference.read, estimate, out, run.common};
  for (std::size_t p = 0; p < out.protocols.size(); ++p) evaluation.evaluate(p);
  for (const EvaluatedFile* file : {&reference.read, &estimate}) {
    const bool is_reference = file == &reference.read;
    for (const std::string& words :
         reading_notes(file->findings, is_reference ? "reference" : "estimate")) {
      metadata.notes.push_back({.detail = words});
    }
    if (!file->findings.damage.empty()) {
      metadata.notes.push_back({.kind = NoteKind::damaged_file,
                                .severity = Severity::decisive,
                                .detail = file->findings.damage});
    }
  }
  std::ranges::move(doctor.get(), std::back_inserter(metadata.notes));
  share_notes(out.protocols, metadata.notes);
  out.result.metadata = std::make_shared<const SequenceMetadata>(std::move(metadata));
  return out;
}

FileEvaluation evaluate_file(const Cell& cell,
                             const EvaluatedSweep& files,
                             const SharedReference& reference) {
  const EvaluatedRun& run = files.runs[cell.dataset];
  try {
    const EvaluatedFile estimate =
        evaluated_estimate(run.estimate, files.arguments, files.has_digits, &reference.read);
    return evaluate_poses(cell, files, reference, estimate);
  } catch (const InputError& error) {
    FileEvaluation out = not_evaluated(cell, files);
    out.result.status = Status::failed;
    out.result.why = error.what();
    for (EvaluationResult& own : out.protocols) own.why_failed = error.what();
    if (reference.content.empty()) return out;  // runs are not compared
    try {
      out.result.metadata =
          std::make_shared<const SequenceMetadata>(metadata_of(run, reference, nullptr));
    } catch (const InputError&) {
      return out;  // the file exists, but cannot be hashed either
    }
    return out;
  }
}

}  // namespace loopbench::harness
