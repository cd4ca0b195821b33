#include "harness/eval/recorded_identity.hpp"

#include "datasets/bags/bag_trajectory.hpp"
#include "harness/model/recorded_run.hpp"
#include "harness/run/sequence_identity.hpp"
#include "harness/run/summarise_sequence.hpp"

namespace loopbench::harness {

InputFile hashed_input(const std::string& name, const std::string& option) {
  return hashed_inputs({{file_of(name), option}}).front();
}

SequenceMetadata metadata_of(const RecordedRun& run,
                             const SharedReference& reference,
                             const RecordedFile* estimate) {
  SequenceMetadata out;
  out.size.reference = static_cast<std::int64_t>(reference.read.poses.size());
  if (estimate) out.size.keyframes = static_cast<std::int64_t>(estimate->poses.size());
  if (reference.content.empty()) return out;
  out.group = recorded_group(run.run,
                             !run.group.empty()            ? "group:" + run.group
                             : reference.recording.empty() ? "reference:" + reference.content
                                                           : "reference:" + reference.recording);
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

std::shared_ptr<const SequenceMetadata> metadata_of_failure(const RecordedRun& run,
                                                            const SharedReference& reference) {
  if (reference.content.empty()) return nullptr;
  try {
    return std::make_shared<const SequenceMetadata>(metadata_of(run, reference, nullptr));
  } catch (const InputError&) {
    return nullptr;  // the file exists, but cannot be hashed either
  }
}

}  // namespace loopbench::harness
