/// What identifies the run of a file, for stores and for copies.
#pragma once

#include <memory>
#include <string>

#include "datasets/bags/bag_trajectory.hpp"
#include "harness/eval/recorded_evaluation.hpp"
#include "harness/model/recorded_run.hpp"
#include "harness/model/sequence_metadata.hpp"
#include "harness/run/summarise_sequence.hpp"

namespace loopbench::harness {

/// `option`: of the dataset, by which the gate finds the reference among the inputs. Throws
/// InputError.
inline InputFile hashed_input(const std::string& name, const std::string& option) {
  return hashed_inputs({{file_of(name), option}}).front();
}

/// Identity of the run, also if the estimate could not be read (null): whether two failures are
/// copies, and whether the file has changed since, is decided as for other runs. Throws InputError.
inline SequenceMetadata metadata_of(const RecordedRun& run,
                                    const SharedReference& reference,
                                    const RecordedFile* estimate) {
  SequenceMetadata out;
  out.size.reference = static_cast<std::int64_t>(reference.read.poses.size());
  if (estimate) out.size.keyframes = static_cast<std::int64_t>(estimate->poses.size());
  if (reference.content.empty()) return out;
  out.group = recorded_group(
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

/// The same without an estimate; null if the file cannot be hashed either, or if runs are not
/// compared.
inline std::shared_ptr<const SequenceMetadata> metadata_of_failure(
    const RecordedRun& run, const SharedReference& reference) {
  if (reference.content.empty()) return nullptr;
  try {
    return std::make_shared<const SequenceMetadata>(metadata_of(run, reference, nullptr));
  } catch (const InputError&) {
    return nullptr;  // the file exists, but cannot be hashed either
  }
}

}  // namespace loopbench::harness
