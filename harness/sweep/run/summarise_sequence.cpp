#include "harness/sweep/run/summarise_sequence.hpp"

#include <algorithm>
#include <cmath>

#include "datasets/derive/poses_at.hpp"
#include "harness/sweep/run/check_output.hpp"
#include "harness/sweep/run/evaluation_notes.hpp"
#include "harness/sweep/text/hash.hpp"
#include "harness/sweep/text/printable.hpp"
#include "metrics/checks/extrinsic_offset.hpp"
#include "metrics/correction/loop_detection.hpp"
#include "metrics/trajectory/position_only.hpp"

namespace loopbench::harness {
namespace {

/// Serialises numbers, members one by one, because padding has undefined values.
class ContentHash {
 public:
  void add(double value) { append(&value, sizeof value); }
  void add(std::uint64_t value) { append(&value, sizeof value); }

  void add(const Pose& pose) {
    for (const double x : pose.translation) add(x);
    for (const double x : pose.rotation.coeffs()) add(x);
  }

  void add(const Trajectory& poses) {
    add(std::uint64_t{poses.size()});
    for (const auto& [stamp, pose] : poses) {
      add(stamp);
      add(pose);
    }
  }

  void add(const std::vector<Edge>& edges) {
    add(std::uint64_t{edges.size()});
    for (const Edge& edge : edges) {
      add(std::uint64_t{edge.from});
      add(std::uint64_t{edge.to});
      add(edge.from_from_to);
      for (const double x : edge.information.reshaped()) add(x);
      add(edge.scale);
      if (edge.scale_information > 0.0) add(edge.scale_information);
    }
  }

  std::string text() { return hex(hash_of(bytes_)); }

 private:
  static constexpr std::size_t kMostBytes = std::size_t{1} << 20;

  void append(const void* data, std::size_t size) {
    if (bytes_.size() + size > kMostBytes) bytes_ = text();
    bytes_.append(static_cast<const char*>(data), size);
  }

  std::string bytes_;  ///< data not yet hashed, after the hash of the preceding data
};

/// Hash of the distances from the first position, which do not depend on the format of the file,
/// on the world frame or the axes, nor on the body, whose offset is undone. Formats and the offset
/// change the last digits, so distances are rounded; few decimal numbers are near a limit of the
/// cells, because of their fraction.
std::string hash_of_shape(const Trajectory& poses, const Pose& body_from_reference) {
  constexpr double kCell = 1e-3;  // [m]
  constexpr double kFraction = 0.3183;
  const auto position = [&](const StampedPose& one) -> Vector3 {
    return (one.world_from_body * body_from_reference).translation;
  };
  const Vector3 first = position(poses.front());
  ContentHash hash;
  hash.add(std::uint64_t{poses.size()});
  for (const StampedPose& one : poses) {
    hash.add(std::floor((position(one) - first).norm() / kCell + kFraction));
  }
  return hash.text();
}

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
  for (Note& note : metadata.notes) note.detail = limited(note.detail, kLongestNote);
  if (omitted > 0) {
    metadata.notes.push_back(
        {.kind = NoteKind::omitted, .numbers = {{"notes", static_cast<double>(omitted)}}});
  }
}

}  // namespace

std::string hash_of_poses(const Trajectory& poses) {
  ContentHash hash;
  hash.add(poses);
  return hash.text();
}

std::string content_of(const Sequence& sequence) {
  const Problem& problem = sequence.problem;
  ContentHash hash;
  hash.add(problem.keyframes);
  hash.add(problem.odometry);
  hash.add(problem.closures);
  hash.add(problem.frames);
  hash.add(std::uint64_t{problem.planar});
  hash.add(std::uint64_t{problem.shared_landmarks.size()});
  for (const std::size_t count : problem.shared_landmarks) hash.add(std::uint64_t{count});
  for (const Anchor& anchor : problem.anchors) {
    hash.add(std::uint64_t{anchor.keyframe});
    for (const double x : anchor.position) hash.add(x);
    for (const double x : anchor.covariance.reshaped()) hash.add(x);
    for (const double x : anchor.point_in_body) hash.add(x);
  }
  hash.add(sequence.reference);
  return hash.text();
}

bool is_recording(const Sequence& sequence) {
  return sequence.provenance.noise.empty() && !sequence.reference.empty();
}

std::string source_of(const Sequence& sequence) {
  const std::string& noise = sequence.provenance.noise;
  if (!noise.empty()) return "noise:" + hex(hash_of(noise));
  if (is_recording(sequence)) {
    const Pose offset = sequence.provenance.body_from_reference.value_or(Pose{});
    return "reference:" + hash_of_shape(sequence.reference, offset);
  }
  return "estimate:" + hash_of_poses(sequence.problem.keyframes);
}

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
  out.group_kind = GroupKind::source;
  if (is_recording(sequence)) out.recording = out.source;
  for (const std::string& note : sequence.provenance.notes) out.notes.push_back({.detail = note});
  if (!sequence.loop_candidates.empty() && !sequence.reference.empty()) {
    out.notes.push_back({.kind = NoteKind::detection,
                         .detail = to_text(metrics::evaluate_detection(
                             problem, sequence.reference, sequence.loop_candidates, {}))});
  }
  if (const std::string which = equal_reference(sequence); !which.empty()) {
    out.notes.push_back(
        {.kind = NoteKind::oracle, .severity = Severity::decisive, .detail = which});
  }
  if (const std::string which = reference_of_other_body(sequence); !which.empty()) {
    out.notes.push_back({.kind = NoteKind::body, .severity = Severity::caution, .detail = which});
  }
  if (with_trace) out.trace = sequence_trace(sequence);
  return out;
}

SequenceMetadata metadata_of(const Sequence& sequence, const Cell& cell, const Sweep& sweep) {
  if (const auto own = with_alignment_of(cell.dataset, sweep)) {
    SequenceMetadata out = metadata_of(sequence, cell, *own);
    out.notes.push_back(
        {.kind = NoteKind::alignment, .detail = to_text(*sweep.datasets[cell.dataset].align)});
    return out;
  }
  SequenceMetadata out = sequence_metadata(sequence, sweep.traces);
  const std::string& group = sweep.datasets[cell.dataset].group;
  if (!group.empty()) {
    out.group = "group:" + group;
    out.group_kind = GroupKind::named;
    out.recording = "";
  }
  for (const auto& notes : {evaluation_notes(sequence, sweep), doctor_notes(sequence, sweep)}) {
    out.notes.insert(out.notes.end(), notes.begin(), notes.end());
  }
  limit_texts(out);
  return out;
}

}  // namespace loopbench::harness
