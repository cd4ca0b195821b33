#include "metrics/doctor/frame_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "metrics/doctor/axis_fit.hpp"
#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/frame_fit.hpp"
#include "metrics/doctor/unit_checks.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

using Change = std::function<Pose(const Pose&)>;

std::vector<Pose> changed(std::vector<Pose> poses, const Change& change) {
  for (Pose& pose : poses) pose = change(pose);
  return poses;
}

Pose reordered(const Pose& pose) {
  // Read as x y z w, written as w x y z.
  const Rotation& q = pose.rotation;
  return {Rotation(q.x(), q.y(), q.z(), q.w()), pose.translation};
}

Pose reordered_back(const Pose& pose) {
  // Read as w x y z, written as x y z w.
  const Rotation& q = pose.rotation;
  return {Rotation(q.z(), q.w(), q.x(), q.y()), pose.translation};
}

Pose with_inverse_rotation(const Pose& pose) {
  return {pose.rotation.conjugate(), pose.translation};
}

/// A hypothesis about one of the trajectories.
struct Hypothesis {
  Fault fault;
  std::string what;    ///< "quaternions are w x y z"
  const char* option;  ///< of `traj transform`
  Change change;
};

const char* file_of(bool is_reference) { return is_reference ? "REF" : "EST"; }
const char* name_of(bool is_reference) { return is_reference ? "reference" : "estimate"; }

/// Inverted poses: the positions fit only after inversion.
std::optional<InputFinding> check_inversion(const CommonPoses& poses) {
  constexpr double kBad = 0.15, kBetter = 0.4;
  const double before = fit_positions(poses.reference, poses.estimate).similarity;
  if (before < kBad) return std::nullopt;
  const Change invert = [](const Pose& pose) { return pose.inverse(); };
  const double of_estimate =
      fit_positions(poses.reference, changed(poses.estimate, invert)).similarity;
  const double of_reference =
      fit_positions(changed(poses.reference, invert), poses.estimate).similarity;
  const double after = std::min(of_estimate, of_reference);
  if (after > kBetter * before) return std::nullopt;
  const bool is_reference = of_reference < of_estimate;
  return InputFinding{
      Fault::inverted_poses,
      fmt::format("inverting the poses of the {} reduces the relative position error "
                  "after alignment from {:.3f} to {:.3f}",
                  name_of(is_reference),
                  before,
                  after),
      fmt::format("traj transform {} --invert-poses", file_of(is_reference)),
      1.0 - after / before,
      is_reference ? 1.0 : 0.0};
}

/// The world frames of positions and rotations differ by this angle [rad].
double disagreement(const ConstantRotations& rotations, const PositionFit& positions) {
  return angle_between(rotations.left, Rotation(positions.rotation));
}

struct Candidate {
  const Hypothesis* hypothesis = nullptr;
  bool of_reference = false;
  double residual = 0.0;      ///< of the rotations [rad]
  double relative = 0.0;      ///< the same of relative rotations [-]
  double disagreement = 0.0;  ///< with the positions [rad]
};

/// The hypotheses about either trajectory, the one that agrees best with the positions first.
std::vector<Candidate> candidates(const CommonPoses& poses, const PositionFit& positions) {
  static const Hypothesis kHypotheses[] = {{Fault::quaternion_order,
                                            "the quaternions are w x y z, read as x y z w,",
                                            "--quaternion-order wxyz",
                                            reordered},
                                           {Fault::quaternion_order,
                                            "the quaternions are x y z w, read as w x y z,",
                                            "--quaternion-order xyzw",
                                            reordered_back},
                                           {Fault::conjugated,
                                            "the rotations are inverted, but not the positions,",
                                            "--conjugate",
                                            with_inverse_rotation}};
  std::vector<Candidate> out;
  for (const Hypothesis& hypothesis : kHypotheses) {
    for (const bool of_reference : {false, true}) {
      const ConstantRotations fit = fit_rotations(
          of_reference ? changed(poses.reference, hypothesis.change) : poses.reference,
          of_reference ? poses.estimate : changed(poses.estimate, hypothesis.change));
      out.push_back(
          {&hypothesis, of_reference, fit.residual, fit.relative, disagreement(fit, positions)});
    }
  }
  std::ranges::sort(out, {}, &Candidate::disagreement);
  return out;
}

/// Rotations that fit only after a change of the quaternions. A wrong order equals an inversion
/// between constant rotations, and an inversion of planar motion equals a mirrored axis, so only
/// the agreement with the positions tells them apart.
std::optional<InputFinding> check_quaternions(const CommonPoses& poses,
                                              const ConstantRotations& as_read,
                                              const PositionFit& positions) {
  constexpr double kBad = 15.0 / kDegrees, kBetter = 0.4, kAgrees = 20.0 / kDegrees;
  constexpr double kDisagrees = 30.0 / kDegrees;
  const bool is_bad = as_read.residual > kBad;
  const double before = disagreement(as_read, positions);
  if (!is_bad && before < kDisagrees) return std::nullopt;
  for (const Candidate& each : candidates(poses, positions)) {
    // Planar motion fits as well after an inversion, so that this has to be clearly better.
    // Drift hides that in the rotations, but hardly in relative ones.
    const bool inverts = each.hypothesis->fault == Fault::conjugated;
    const double most = is_bad || inverts ? kBetter : 1.0;
    const bool is_better = each.residual < most * as_read.residual ||
                           (inverts && each.relative < kBetter * as_read.relative);
    const bool fits = is_better && (is_bad || each.disagreement < kAgrees);
    if (!fits) continue;
    return InputFinding{
        each.hypothesis->fault,
        fmt::format("{} in the {}: the median difference of rotations changes from "
                    "{:.1f} to {:.1f} deg, and their difference to the positions' "
                    "frame from {:.0f} to {:.0f} deg",
                    each.hypothesis->what,
                    name_of(each.of_reference),
                    kDegrees * as_read.residual,
                    kDegrees * each.residual,
                    kDegrees * before,
                    kDegrees * each.disagreement),
        fmt::format("traj transform {} {}", file_of(each.of_reference), each.hypothesis->option),
        1.0 - (is_bad ? std::min(each.residual / as_read.residual, each.relative / as_read.relative)
                      : each.disagreement / before),
        each.of_reference ? 1.0 : 0.0};
  }
  return std::nullopt;
}

/// Positions and rotations that do not belong together, but do with other axes of the positions.
std::optional<InputFinding> check_axes(const CommonPoses& poses) {
  constexpr double kBad = 0.1, kBetter = 0.5;
  const AxisFit fit = fit_axes(poses.reference, poses.estimate);
  if (fit.as_read < kBad || fit.changed > kBetter * fit.as_read) return std::nullopt;
  return InputFinding{
      Fault::axes,
      fmt::format("the axes of positions and rotations differ: with {} of the estimate's positions "
                  "as x y z, displacements in body frames differ by {:.3f} of their length, as "
                  "read by {:.3f}",
                  fit.text(),
                  fit.changed,
                  fit.as_read),
      fmt::format("traj transform EST --axes={}", fit.option()),
      1.0 - fit.changed / fit.as_read,
      fit.as_read};
}

}  // namespace

bool has_rotations(const std::vector<Pose>& poses) {
  return std::ranges::any_of(poses, [&](const Pose& pose) {
    return angle_between(pose.rotation, poses.front().rotation) > kLeastRotation;
  });
}

std::vector<InputFinding> check_frames(const Trajectory& reference, const Trajectory& estimate) {
  std::vector<InputFinding> out;
  const CommonPoses poses = common_poses(reference, estimate, 0.0, kMostFramePoses);
  if (poses.stamps.size() < kFewestFramePoses) return out;
  const PositionFit positions = fit_positions(poses.reference, poses.estimate);
  const bool rotates = has_rotations(poses.reference) && has_rotations(poses.estimate);
  if (rotates) {
    if (auto finding = check_inversion(poses)) return {*finding};
  }
  if (!rotates) return out;
  if (check_angle_unit(poses)) return out;  // reported by check_units()
  const ConstantRotations rotations = fit_rotations(poses.reference, poses.estimate);
  if (auto finding = check_quaternions(poses, rotations, positions)) {
    out.push_back(*finding);
  } else if (auto mismatch = check_axes(poses)) {
    out.push_back(*mismatch);
  }
  return out;
}

}  // namespace loopbench::metrics
