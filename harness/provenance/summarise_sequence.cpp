#include "harness/provenance/summarise_sequence.hpp"

#include <fmt/format.h>

#include "datasets/derive/poses_at.hpp"
#include "harness/provenance/copied_reference.hpp"
#include "harness/provenance/oracle_closures.hpp"
#include "harness/provenance/sequence_identity.hpp"
#include "harness/text/hash.hpp"
#include "metrics/checks/extrinsic_offset.hpp"
#include "metrics/correction/loop_detection.hpp"
#include "metrics/trajectory/position_only.hpp"

namespace loopbench::harness {
namespace {

/// Warning if the motion of the raw keyframes indicates another body than the reference's;
/// otherwise empty.
std::string reference_of_other_body(const Sequence& sequence) {
  const Trajectory& keyframes = sequence.problem.keyframes;
  if (sequence.reference.empty() || metrics::is_position_only(sequence.reference)) return "";
  const auto reference_poses = poses_at(sequence.reference, stamps(keyframes), {});
  Trajectory estimate, reference;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    if (!reference_poses[i]) continue;
    estimate.push_back(keyframes[i]);
    reference.push_back({keyframes[i].stamp, *reference_poses[i]});
  }
  const auto offset = metrics::extrinsic_offset(reference, estimate, {});
  const std::optional<Pose>& stated = sequence.provenance.body_from_reference;
  const std::string text = offset ? metrics::other_body(*offset, stated.value_or(Pose{})) : "";
  return text.empty() || !stated ? text : text + "; see reference_body of the dataset";
}

/// Marks closures that equal the reference as oracle closures, for any source file.
void flag_oracle_closures(SequenceMetadata& out, const Sequence& sequence) {
  if (out.oracle_closures) return;
  const std::size_t all = sequence.problem.closures.size();
  const std::size_t equal = closures_equal_to_reference(sequence);
  if (!are_oracle_closures(equal, all)) return;
  out.oracle_closures = true;
  out.closures += fmt::format("; {} of {} equal the reference", equal, all);
}

}  // namespace

std::vector<InputFile> hashed_inputs(const std::vector<InputPath>& files) {
  std::vector<InputFile> out;
  for (const auto& [path, option] : files) {
    if (!std::filesystem::exists(path)) {
      out.push_back({option, path.string(), 0, "missing"});
      continue;
    }
    const std::string hash = hex(hash_of_file(path));
    out.push_back({option, path.string(), std::filesystem::file_size(path), hash});
  }
  return out;
}

SequenceMetadata sequence_metadata(const Sequence& sequence, bool with_trace) {
  SequenceMetadata out;
  out.inputs = hashed_inputs(sequence.provenance.inputs);
  out.closures = sequence.provenance.closures;
  out.oracle_closures = sequence.provenance.oracle_closures;
  const auto count = [](const auto& items) { return static_cast<std::int64_t>(items.size()); };
  const Problem& problem = sequence.problem;
  out.size = {count(problem.keyframes),
              count(problem.odometry),
              count(problem.closures),
              count(problem.frames),
              count(sequence.reference)};
  flag_oracle_closures(out, sequence);
  out.content = content_of(sequence);
  out.source = source_of(sequence);
  out.group = out.source;
  out.notes = sequence.provenance.notes;
  if (!sequence.loop_candidates.empty() && !sequence.reference.empty()) {
    out.notes.push_back(to_text(metrics::evaluate_detection(sequence, {})));
  }
  if (const std::string note = copied_reference(sequence); !note.empty()) {
    out.notes.push_back("oracle: " + note);
  }
  if (const std::string note = reference_of_other_body(sequence); !note.empty()) {
    out.notes.push_back(note);
  }
  if (with_trace) out.trace = sequence_trace(sequence);
  return out;
}

}  // namespace loopbench::harness
