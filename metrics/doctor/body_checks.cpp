#include "metrics/doctor/body_checks.hpp"

#include <fmt/format.h>

#include <utility>

#include "metrics/checks/extrinsic_offset.hpp"
#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/frame_checks.hpp"
#include "metrics/doctor/unit_checks.hpp"

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

}  // namespace loopbench::metrics
