#include "harness/commands/eval/file_evaluation.hpp"

#include <algorithm>
#include <future>
#include <iterator>
#include <memory>
#include <optional>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/core/parallel.hpp"
#include "harness/commands/eval/common_parts.hpp"
#include "harness/commands/eval/evaluation_checks.hpp"
#include "harness/commands/eval/pair_evaluation.hpp"
#include "harness/sweep/model/evaluated_run.hpp"
#include "harness/sweep/model/note_text.hpp"
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
  set_evaluated_group(
      out, run.run, run.group.empty() ? "reference:" + reference.content : "group:" + run.group);
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
  evaluate_pair({files, reference.read, estimate, run.common}, out);
  for (const EvaluatedFile* file : {&reference.read, &estimate}) {
    const bool is_reference = file == &reference.read;
    std::ranges::move(reading_notes(file->findings, is_reference ? "reference" : "estimate"),
                      std::back_inserter(metadata.notes));
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
  bool is_read = false;
  try {
    const EvaluatedFile estimate =
        evaluated_estimate(run.estimate, files.arguments, files.has_digits, &reference.read);
    is_read = true;
    return evaluate_poses(cell, files, reference, estimate);
  } catch (const InputError& error) {
    FileEvaluation out = not_evaluated(cell, files);
    out.result.status = Status::failed;
    out.result.why = error.what();
    for (EvaluationResult& own : out.protocols) {
      own.why_failed = error.what();
      own.names_files = !is_read;
    }
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
