#include "metrics/doctor/body_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "metrics/checks/extrinsic_offset.hpp"
#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/frame_checks.hpp"
#include "metrics/doctor/frame_fit.hpp"
#include "metrics/doctor/unit_checks.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {

std::optional<LeverArm> find_lever_arm(const Trajectory& reference, const Trajectory& estimate) {
  constexpr double kExplained = 0.5;
  const CommonPoses poses = common_poses(reference, estimate, 0.0, kMostFramePoses);
  if (poses.stamps.size() < kFewestFramePoses) return std::nullopt;
  if (!has_rotations(poses.reference) || !has_rotations(poses.estimate)) return std::nullopt;
  Trajectory of_reference, of_estimate;
  for (std::size_t i = 0; i < poses.stamps.size(); ++i) {
    of_reference.push_back({poses.stamps[i], poses.reference[i]});
    of_estimate.push_back({poses.stamps[i], poses.estimate[i]});
  }
  const auto found = extrinsic_offset(of_reference, of_estimate, ExtrinsicOffsetOptions{});
  if (!found || found->fit.lever_arm_explained < kExplained) return std::nullopt;
  const Pose& body_from_reference = found->fit.body_from_reference;
  const double distance = body_from_reference.translation.norm();
  return LeverArm{
      {Fault::lever_arm,
       fmt::format(
           "the reference is that of a body {:.3g} m away: this lever arm explains {:.0f} % "
           "of the squared differences of displacements over {} rotations",
           distance,
           100.0 * found->fit.lever_arm_explained,
           found->relative_poses),
       fmt::format("--ref-body={}", body_option(body_from_reference)),
       found->fit.lever_arm_explained,
       distance},
      body_from_reference};
}

void add_lever_arm(std::vector<InputFinding>& conventions,
                   const Trajectory& reference,
                   const Trajectory& estimate) {
  const bool is_scaled = conventions.size() == 1 && conventions[0].fault == Fault::scale;
  if (!conventions.empty() && !is_scaled) return;
  auto found = find_lever_arm(reference, estimate);
  if (found && is_scaled) {
    Trajectory moved = estimate;
    for (auto& [stamp, pose] : moved) pose = pose * found->body_from_reference;
    if (check_units(reference, moved).empty()) {
      conventions = {std::move(found->finding)};
      return;
    }
  }
  if (is_scaled) {
    Trajectory scaled = estimate;
    for (auto& [stamp, pose] : scaled) pose.translation *= conventions[0].value;
    found = find_lever_arm(reference, scaled);
  }
  if (found) conventions.insert(conventions.begin(), std::move(found->finding));
}

std::optional<InputFinding> find_body_rotation(const Trajectory& reference,
                                               const Trajectory& estimate) {
  constexpr double kLarge = 30.0 / kDegrees, kSmall = 15.0 / kDegrees, kLeft = 0.4;
  if (lacks_rotations(reference) || lacks_rotations(estimate)) return std::nullopt;
  const CommonPoses poses = common_poses(reference, estimate, 0.0, kMostFramePoses);
  if (poses.stamps.size() < kFewestFramePoses) return std::nullopt;
  const auto is_turned = [&](const Pose& pose) {
    return angle_between(pose.rotation, poses.reference.front().rotation) > kLarge;
  };
  const auto turned = std::ranges::count_if(poses.reference, is_turned);
  if (10 * static_cast<std::size_t>(turned) < poses.reference.size()) return std::nullopt;
  const PositionFit positions = fit_positions(poses.reference, poses.estimate);
  const RotationErrors errors =
      rotation_errors(poses.reference, poses.estimate, Rotation(positions.rotation));
  const double angle = angle_between(errors.body_from_reference, Rotation::Identity());
  const double after = errors.of_another_body;
  if (angle < kLarge || after > std::min(kSmall, kLeft * errors.as_read)) return std::nullopt;
  return InputFinding{
      Fault::body_rotation,
      fmt::format(
          "the reference's body is rotated by {:.1f} deg: after alignment of the positions, "
          "the median rotation error is {:.1f} deg, and {:.1f} deg with this rotation",
          kDegrees * angle,
          kDegrees * errors.as_read,
          kDegrees * after),
      fmt::format("--ref-body={}", body_option({errors.body_from_reference, Vector3::Zero()})),
      1.0 - after / errors.as_read,
      angle};
}

}  // namespace loopbench::metrics
