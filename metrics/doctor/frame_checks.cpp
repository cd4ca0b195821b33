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

/// Rotations that differ by less are right but for drift and alignment [rad].
constexpr double kSmallError = 20.0 / kDegrees;

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
  ConstantRotations fit;
  RotationErrors errors;
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
      const std::vector<Pose> reference =
          of_reference ? changed(poses.reference, hypothesis.change) : poses.reference;
      const std::vector<Pose> estimate =
          of_reference ? poses.estimate : changed(poses.estimate, hypothesis.change);
      const ConstantRotations fit = fit_rotations(reference, estimate);
      out.push_back({&hypothesis,
                     of_reference,
                     fit,
                     rotation_errors(reference, estimate, Rotation(positions.rotation)),
                     disagreement(fit, positions)});
    }
  }
  // Those after which the rotations are right as read come first. Of planar motion, several are:
  // then in the order above.
  constexpr double kEqual = 5.0 / kDegrees;
  double least = kSmallError;
  for (const Candidate& each : out) least = std::min(least, each.errors.as_read);
  std::ranges::stable_sort(out, {}, [&](const Candidate& each) {
    const bool is_right = each.errors.as_read < std::min(kSmallError, least + kEqual);
    return is_right ? -1.0 : each.disagreement;
  });
  return out;
}

/// A measure of the rotations before and after a change [rad].
struct Improvement {
  std::string what;
  double before = 0.0;
  double after = 0.0;
};

/// The rotation error after alignment of the positions, if a change reduces it much: as read, or up
/// to a constant rotation of the body, which is another mistake. What `eval` prints has to become
/// better: of planar motion, a wrong order is only a constant rotation, and the frames fitted to
/// rotations are ambiguous by half a turn.
std::optional<Improvement> improvement(const RotationErrors& before, const RotationErrors& after) {
  constexpr double kBetter = 0.5;
  const std::string what = "after alignment of the positions, the median rotation error";
  if (after.as_read < std::min(kSmallError, kBetter * before.as_read)) {
    return Improvement{what, before.as_read, after.as_read};
  }
  if (!(after.of_another_body < kBetter * before.of_another_body)) return std::nullopt;
  return Improvement{what + ", up to a constant rotation of the body,",
                     before.of_another_body,
                     after.of_another_body};
}

/// Rotations that fit only after a change of the quaternions. A wrong order equals an inversion
/// between constant rotations, and an inversion of planar motion equals a mirrored axis, so only
/// the agreement with the positions tells them apart.
std::optional<InputFinding> check_quaternions(const CommonPoses& poses,
                                              const ConstantRotations& as_read,
                                              const PositionFit& positions) {
  constexpr double kBad = 15.0 / kDegrees, kBetter = 0.4, kAgrees = 20.0 / kDegrees;
  constexpr double kDisagrees = 30.0 / kDegrees, kEqual = 0.01 / kDegrees;
  const bool is_bad = as_read.residual > kBad;
  const RotationErrors before =
      rotation_errors(poses.reference, poses.estimate, Rotation(positions.rotation));
  const bool agrees = disagreement(as_read, positions) < kDisagrees && before.as_read < kBad;
  if (!is_bad && agrees) return std::nullopt;
  for (const Candidate& each : candidates(poses, positions)) {
    // Planar motion fits as well after an inversion, so that this has to be clearly better.
    // Drift hides that in the rotations, but hardly in relative ones.
    const bool inverts = each.hypothesis->fault == Fault::conjugated;
    const double most = is_bad || inverts ? kBetter : 1.05;
    const bool is_better = each.fit.residual < most * as_read.residual + kEqual ||
                           (inverts && each.fit.relative < kBetter * as_read.relative);
    const bool agrees_then = each.disagreement < kAgrees || each.errors.as_read < kSmallError;
    if (!is_better || (!is_bad && !agrees_then)) continue;
    const std::optional<Improvement> gain = improvement(before, each.errors);
    if (!gain) continue;
    return InputFinding{
        each.hypothesis->fault,
        fmt::format("{} in the {}: {} changes from {:.1f} to {:.1f} deg",
                    each.hypothesis->what,
                    name_of(each.of_reference),
                    gain->what,
                    kDegrees * gain->before,
                    kDegrees * gain->after),
        fmt::format("traj transform {} {}", file_of(each.of_reference), each.hypothesis->option),
        1.0 - gain->after / gain->before,
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
