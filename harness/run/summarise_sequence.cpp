#include "harness/run/summarise_sequence.hpp"

#include <algorithm>

#include "datasets/derive/poses_at.hpp"
#include "harness/base/hash.hpp"
#include "harness/base/printable.hpp"
#include "harness/run/check_output.hpp"
#include "harness/run/doctor_notes.hpp"
#include "harness/run/evaluation_notes.hpp"
#include "harness/run/sequence_identity.hpp"
#include "metrics/checks/extrinsic_offset.hpp"
#include "metrics/correction/loop_detection.hpp"
#include "metrics/trajectory/position_only.hpp"

namespace loopbench::harness {
namespace {

/// Whether all poses are poses of the reference: equal stamps, positions and rotations.
bool are_of_reference(const Trajectory& poses, const Trajectory& reference) {
  auto next = reference.begin();
  for (const auto& [stamp, own] : poses) {
    next = std::ranges::lower_bound(next, reference.end(), stamp, {}, &StampedPose::stamp);
    if (next == reference.end() || next->stamp != stamp) return false;
    const Pose& same = next->world_from_body;
    if (own.translation != same.translation) return false;
    if (own.rotation.coeffs() != same.rotation.coeffs()) return false;
  }
  return !poses.empty();
}

/// "the estimate equals the reference" or "the frames equal the reference", if all keyframes (or
/// frames) are poses of the reference; otherwise empty. Empty for simulated data, whose odometry
/// can be noise-free. O(poses log(poses)).
std::string equal_reference(const Sequence& sequence) {
  if (!sequence.provenance.noise.empty()) return "";
  const Problem& problem = sequence.problem;
  if (are_of_reference(problem.keyframes, sequence.reference)) {
    return "the estimate equals the reference";
  }
  if (are_of_reference(problem.frames, sequence.reference)) return "the frames equal the reference";
  return "";
}

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

/// A dataset of a plugin can return any text, which would be printed and stored for every cell.
void limit_texts(SequenceMetadata& metadata) {
  metadata.closures = limited(metadata.closures, kLongestNote);
  const std::size_t omitted = metadata.notes.size() - std::min(metadata.notes.size(), kMostItems);
  metadata.notes.resize(metadata.notes.size() - omitted);
  for (std::string& note : metadata.notes) note = limited(note, kLongestNote);
  if (omitted > 0) metadata.notes.push_back(std::to_string(omitted) + " more notes");
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
  out.content = content_of(sequence);
  out.source = source_of(sequence);
  out.group = out.source;
  out.notes = sequence.provenance.notes;
  if (!sequence.loop_candidates.empty() && !sequence.reference.empty()) {
    out.notes.push_back(to_text(metrics::evaluate_detection(sequence, {})));
  }
  if (const std::string note = equal_reference(sequence); !note.empty()) {
    out.notes.push_back("oracle: " + note);
  }
  if (const std::string note = reference_of_other_body(sequence); !note.empty()) {
    out.notes.push_back(note);
  }
  if (with_trace) out.trace = sequence_trace(sequence);
  return out;
}

SequenceMetadata metadata_of(const Sequence& sequence, const Cell& cell, const Sweep& sweep) {
  SequenceMetadata out = sequence_metadata(sequence, sweep.traces);
  const std::string& group = sweep.datasets[cell.dataset].group;
  if (!group.empty()) out.group = "group:" + group;
  for (const auto& notes : {evaluation_notes(sequence, sweep), doctor_notes(sequence, sweep)}) {
    out.notes.insert(out.notes.end(), notes.begin(), notes.end());
  }
  limit_texts(out);
  return out;
}

}  // namespace loopbench::harness
