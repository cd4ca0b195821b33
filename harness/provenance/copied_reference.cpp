#include "harness/provenance/copied_reference.hpp"

#include "datasets/derive/poses_at.hpp"
#include "metrics/trajectory/position_only.hpp"

namespace loopbench::harness {
namespace {

constexpr double kCopyDistance = 1e-4;  // [m]; rounding of trajectory files is at most this
constexpr double kCopyAngle = 1e-4;     // [rad]

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

}  // namespace

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

}  // namespace loopbench::harness
