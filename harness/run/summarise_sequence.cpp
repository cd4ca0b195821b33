#include "harness/run/summarise_sequence.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "datasets/derive/poses_at.hpp"
#include "harness/base/hash.hpp"
#include "harness/base/printable.hpp"
#include "harness/catalogue/oracle_closures.hpp"
#include "harness/run/check_output.hpp"
#include "harness/run/doctor_notes.hpp"
#include "harness/run/evaluation_notes.hpp"
#include "harness/run/sequence_identity.hpp"
#include "metrics/checks/extrinsic_offset.hpp"
#include "metrics/correction/loop_detection.hpp"
#include "metrics/trajectory/position_only.hpp"

namespace loopbench::harness {
namespace {

bool is_copy(const Trajectory& poses, const Trajectory& reference) {
  const auto truth = poses_at(reference, stamps(poses), {});
  std::optional<std::size_t> first;
  std::size_t paired = 0;
  bool moves = false;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!truth[i]) continue;
    ++paired;
    if (!first) first = i;
    const Pose own = poses[*first].world_from_body.inverse() * poses[i].world_from_body;
    const Pose same = truth[*first]->inverse() * *truth[i];
    if (!is_close(own, same, kCopyDistance, kCopyAngle)) return false;
    moves = moves || !is_close(same, Pose{}, kCopyDistance, kCopyAngle);
  }
  return moves && 2 * paired >= poses.size();
}

/// "the estimate equals the reference" or "the frames equal the reference", if all keyframes (or
/// frames) have the relative poses of the reference to within 0.1 mm and 0.1 mrad, in any world
/// frame; otherwise empty. The reference is interpolated at their stamps; at least half of them,
/// and a motion beyond these limits, are needed. Empty for simulated data, whose odometry can be
/// noise-free, and for a reference without orientations. O(poses).
std::string copied_reference(const Sequence& sequence) {
  const bool measured = sequence.provenance.noise.empty();
  if (!measured || sequence.reference.empty()) return "";
  if (metrics::is_position_only(sequence.reference)) return "";
  if (is_copy(sequence.problem.keyframes, sequence.reference)) {
    return "the estimate equals the reference";
  }
  if (is_copy(sequence.problem.frames, sequence.reference)) return "the frames equal the reference";
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

/// Marks closures that equal the reference as oracle closures, for any source file.
void flag_oracle_closures(SequenceMetadata& out, const Sequence& sequence) {
  if (out.oracle_closures) return;
  const std::size_t equal = undeclared_oracle_closures(sequence);
  if (equal == 0) return;
  out.oracle_closures = true;
  out.closures +=
      fmt::format("; {} of {} equal the reference", equal, sequence.problem.closures.size());
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
