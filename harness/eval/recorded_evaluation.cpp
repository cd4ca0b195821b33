#include "harness/eval/recorded_evaluation.hpp"

#include <algorithm>
#include <memory>

#include "datasets/bags/bag_name.hpp"
#include "datasets/core/parallel.hpp"
#include "harness/eval/evaluate_files.hpp"
#include "harness/execution/run/doctor_notes.hpp"
#include "harness/execution/run/evaluation_notes.hpp"
#include "harness/execution/run/run_cell.hpp"
#include "harness/model/recorded_run.hpp"
#include "harness/provenance/sequence_identity.hpp"
#include "harness/provenance/summarise_sequence.hpp"

namespace loopbench::harness {
namespace {

/// `option`: of the dataset, by which the gate finds the reference among the inputs.
InputFile hashed_input(const std::string& name, const std::string& option) {
  return hashed_inputs({{file_of(name), option}}).front();
}

/// Identity of the run, also if the estimate could not be read: whether two failures are copies,
/// and whether the file has changed since, is decided as for other runs.
SequenceMetadata metadata_of(const Params& options, const SharedReference& reference) {
  SequenceMetadata out;
  out.inputs = {reference.file, hashed_input(to_text(options.at("estimate")), "estimate")};
  out.size.reference = static_cast<std::int64_t>(reference.read.poses.size());
  out.source = "reference:" + reference.content;
  out.group = recorded_group(to_text(options.at("run")), reference.content);
  return out;
}

std::shared_ptr<const SequenceMetadata> metadata_of_failure(const Params& options,
                                                            const SharedReference& reference) {
  try {
    SequenceMetadata out = metadata_of(options, reference);
    out.content = unreadable_content(reference.content, to_text(options.at("estimate")));
    return std::make_shared<const SequenceMetadata>(std::move(out));
  } catch (const InputError&) {
    return nullptr;  // the file exists, but cannot be hashed either
  }
}

/// Notes of the readers, the doctor and the evaluation.
std::vector<std::string> notes_of(const Sequence& sequence,
                                  const Sweep& sweep,
                                  const RecordedFile& reference,
                                  const RecordedFile& estimate,
                                  const std::string& estimate_name) {
  std::vector<std::string> out;
  for (const RecordedFile* file : {&reference, &estimate}) {
    if (!file->findings.damage.empty()) out.push_back("damaged file: " + file->findings.damage);
  }
  const bool has_stamps = reference.unstamped.empty() && estimate.unstamped.empty();
  const std::vector<std::string> findings = doctor_notes({sequence.reference,
                                                          sequence.problem.keyframes,
                                                          sequence.provenance.reference.string(),
                                                          estimate_name,
                                                          has_stamps},
                                                         sweep.protocols);
  out.insert(out.end(), findings.begin(), findings.end());
  const std::vector<std::string> of_evaluation = evaluation_notes(sequence, sweep);
  out.insert(out.end(), of_evaluation.begin(), of_evaluation.end());
  return out;
}

void check_clocks(const EvalArguments& a,
                  const Sweep& sweep,
                  const RecordedFile& reference,
                  const RecordedFile& estimate) {
  for (const metrics::NamedProtocol& protocol : sweep.protocols) {
    const std::string why =
        why_two_clocks(a, protocol.rules, reference.unstamped, estimate.unstamped);
    if (!why.empty()) throw InputError(why);
  }
}

/// Of copying the poses of a file.
void remove_costs(CellResult& result) {
  result.seconds.clear();
  result.cpu_seconds.clear();
  result.peak_memory.reset();
  result.added_memory.reset();
  result.allocations.reset();
  result.report.phases.clear();
}

CellResult evaluated(const Cell& cell,
                     const Sweep& sweep,
                     const SharedReference& reference,
                     const Catalogue& catalogue,
                     const EvalArguments& a) {
  const Params& options = sweep.datasets[cell.dataset].dataset.options;
  CellResult out;
  try {
    RecordedFile estimate = recorded_estimate(options);
    check_clocks(a, sweep, reference.read, estimate);
    const Sequence sequence =
        recorded_sequence(options, reference.read.poses, std::move(estimate.poses));
    out = run_cell(cell, sweep, sequence, catalogue);
    remove_costs(out);
    SequenceMetadata metadata = metadata_of(options, reference);
    metadata.size.keyframes = static_cast<std::int64_t>(sequence.problem.keyframes.size());
    metadata.content = content_of(sequence);
    metadata.notes =
        notes_of(sequence, sweep, reference.read, estimate, to_text(options.at("estimate")));
    metadata.trace = sequence_trace(sequence);
    out.metadata = std::make_shared<const SequenceMetadata>(std::move(metadata));
  } catch (const InputError& error) {
    out = CellResult{};
    out.cell = cell;
    out.status = Status::failed;
    out.why = error.what();
    out.metadata = metadata_of_failure(options, reference);
  }
  return out;
}

}  // namespace

std::string reference_content(const Trajectory& reference) { return pair_content(reference, {}); }

std::string pair_content(const Trajectory& reference, const Trajectory& estimate) {
  Sequence sequence;
  sequence.reference = reference;
  sequence.problem.keyframes = estimate;
  return content_of(sequence);
}

std::string unreadable_content(const std::string& reference_content, const std::string& estimate) {
  try {
    const std::string hash = hashed_input(estimate, "estimate").hash;
    return Fields().add("unreadable").add(reference_content).add(hash).hashed();
  } catch (const InputError&) {
    return "";
  }
}

SharedReference shared_reference(const Params& options) {
  SharedReference out{
      recorded_reference(options), hashed_input(to_text(options.at("reference")), "reference"), ""};
  out.content = reference_content(out.read.poses);
  return out;
}

std::vector<CellResult> evaluate_recorded(const std::vector<Cell>& cells,
                                          const SharedReference& reference,
                                          const Sweep& sweep,
                                          const Catalogue& catalogue,
                                          const EvalArguments& a) {
  std::vector<CellResult> out(cells.size());
  const std::size_t threads = std::min(hardware_threads(), cells.size());
  parallel_invoke(threads, [&](std::size_t thread) {
    for (std::size_t i = thread; i < cells.size(); i += threads) {
      out[i] = evaluated(cells[i], sweep, reference, catalogue, a);
    }
  });
  return out;
}

}  // namespace loopbench::harness
