#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "metrics/checks/extrinsic_offset.hpp"
#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/conventions.hpp"
#include "metrics/doctor/pair_checks.hpp"
#include "metrics/doctor/position_lever.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

constexpr double kPenalty = 0.1;  // of the gain, for a sign or a parameter that a repair changes

struct Repair {
  Fault::Name fault;
  std::string what;      ///< "quaternions in the order w x y z of the estimate"
  std::string fix;       ///< a command or an option
  double value = 0.0;    ///< see InputFinding::value
  double penalty = 0.0;  ///< of the gain: of two that fit alike, the simpler one is chosen
  PoseChange change;
  bool of_reference = false;
  bool is_lever_arm = false;
  bool mirrors_poses = false;  ///< positions and rotations alike

  void apply(Paired& poses) const {
    for (auto& [stamp, pose] : of_reference ? poses.reference : poses.estimate) pose = change(pose);
  }
};

const char* file_of(bool of_reference) { return of_reference ? "REF" : "EST"; }

/// Axes are those of the estimate.
void add_conventions(std::vector<Repair>& to) {
  for (const auto& [fault, what, option, unusual, change] : conventions(false)) {
    for (const bool of_reference : {false, true}) {
      if (of_reference && (fault == Fault::axes || fault == Fault::mirrored)) continue;
      to.push_back({fault,
                    what + " of the " + (of_reference ? "reference" : "estimate"),
                    fmt::format("traj transform {} {}", file_of(of_reference), option),
                    0.0,
                    kPenalty * (unusual + (of_reference ? 0.2 : 0.0)),
                    change,
                    of_reference,
                    false,
                    option.starts_with("--mirror")});
    }
  }
}

/// Millimetres or centimetres, or an arbitrary scale.
void add_scale(std::vector<Repair>& to, const Paired& poses) {
  constexpr double kLeastScale = 0.05;  // logarithm; smaller ones are drift
  const double scale = std::cbrt(similarity(poses).linear().determinant());
  if (std::abs(std::log(scale)) < kLeastScale) return;
  const bool of_reference = scale > 1.0;  // whose numbers are larger than those of metres
  std::string fix = "--align sim3";
  for (const auto& [factor, unit] : {std::pair{0.001, "millimetres"}, {0.01, "centimetres"}}) {
    if (std::abs(std::abs(std::log(scale)) + std::log(factor)) > kLeastScale) continue;
    fix = fmt::format("traj transform {} --scale {} ({} to metres){}",
                      file_of(of_reference),
                      factor,
                      unit,
                      of_reference && factor < 0.01 ? ", or EST --scale 1000 (kilometres)" : "");
  }
  to.push_back({Fault::scale,
                fmt::format("the estimate has scale {:.4g}", 1.0 / scale),
                fix,
                1.0 / scale,
                2.0 * kPenalty,
                [=](const Pose& p) -> Pose {
                  return {p.rotation, scale * p.translation};
                }});
}

/// Axes and lever arm of another body.
void add_bodies(std::vector<Repair>& to, const Paired& poses) {
  constexpr double kLeastAngle = 10.0 / kDegrees, kExplained = 0.5;
  const auto add = [&](const Pose& by, double value, double parameters, const std::string& what) {
    to.push_back({Fault::other_body,
                  "the reference is that of a body " + what,
                  "--ref-body=" + body_option(by),
                  value,
                  parameters * kPenalty,
                  [=](const Pose& p) { return p * by; },
                  false,
                  by.translation.norm() > 0.0});
  };
  const Rotation axes = body_rotation(poses);
  const double angle = angle_between(axes, Rotation::Identity());
  if (angle > kLeastAngle) {
    add({axes, Vector3::Zero()},
        angle,
        7.0,
        fmt::format("with axes rotated by {:.1f} deg", kDegrees * angle));
  }
  const auto found = extrinsic_offset(poses.reference, poses.estimate, ExtrinsicOffsetOptions{});
  if (!found || found->fit.lever_arm_explained <= kExplained) return;
  const Pose& body = found->fit.body_from_reference;
  const double length = body.translation.norm();
  add(body,
      length,
      body.rotation.vec().norm() > 0.0 ? 12.0 : 1.0,
      fmt::format("{:.3g} m away", length));
}

/// Whether short motions agree much less after a repair: it explains something else.
bool spoils_motions(const Agreement& before, const Agreement& after) {
  constexpr double kFactor = 2.0, kLeast = 0.1;
  const auto is_worse = [&](double was, double is) { return is > kFactor * was + kLeast; };
  return is_worse(before.displacement, after.displacement) ||
         is_worse(before.turning, after.turning);
}

/// Whether short motions agree better after a repair.
bool mends_motions(const Agreement& before, const Agreement& after) {
  constexpr double kMost = 0.75;
  return after.displacement < kMost * before.displacement || after.turning < kMost * before.turning;
}

/// Whether steps and rotations in body frames correlate as they are. Mirrored poses rotate in the
/// other sense; poses in a plane that drift by a quarter of a rotation can fit better upside down,
/// which changes no motion in the plane.
bool have_same_sense(const Paired& poses) {
  constexpr double kLeastCommon = 0.5;
  double common[2] = {}, squares[2][2] = {};
  const std::size_t n = poses.estimate.size(), step = n / 200 + 1;
  for (std::size_t i = 0; i + step < n; ++i) {
    const auto motion = [&](const Trajectory& list) {
      return log_se3(list[i].world_from_body.inverse() * list[i + step].world_from_body);
    };
    const Twist a = motion(poses.reference), b = motion(poses.estimate);
    for (const int part : {0, 1}) {
      const Vector3 of_a = a.segment<3>(3 * part), of_b = b.segment<3>(3 * part);
      common[part] += of_a.dot(of_b);
      squares[part][0] += of_a.squaredNorm();
      squares[part][1] += of_b.squaredNorm();
    }
  }
  const auto is_alike = [&](int part) {
    return common[part] > kLeastCommon * std::sqrt(squares[part][0] * squares[part][1]);
  };
  return is_alike(0) && is_alike(1);
}

/// Of positions, if the estimate rotates.
void add_antenna(std::vector<Repair>& to, const Paired& poses) {
  constexpr double kOfDeviation = 2.1;  // 95 % with the scatter of twenty parts
  if (largest_rotation_angle(poses.estimate) < kLeastRotation) return;
  const auto found = position_lever(poses);
  if (!found) return;
  const Vector3 half = kOfDeviation * found->deviation;
  const Pose by{Rotation::Identity(), found->arm};
  to.push_back({Fault::other_body,
                fmt::format("the reference's positions are those of an antenna or prism {:.3g} m "
                            "away (+- {:.2g}, {:.2g}, {:.2g} m, 95 %)",
                            found->arm.norm(),
                            half.x(),
                            half.y(),
                            half.z()),
                "--ref-body=" + body_option(by),
                found->arm.norm(),
                kPenalty,
                [=](const Pose& p) { return p * by; },
                false,
                true});
}

}  // namespace

std::optional<InputFinding> apply_best_repair(Paired& poses,
                                              const std::vector<InputFinding>& found,
                                              bool has_positions_only) {
  constexpr double kLeastGain = 0.7, kMostAfter = 0.75;  // a factor of 2 in the errors
  // Drift resembles lever arms, even more where rotations cannot contradict them.
  constexpr double kLeastOfLeverArm = 0.2;
  const double most_of_lever_arm = has_positions_only ? 0.4 : 0.6;
  const Agreement before = agreement(poses);
  const bool is_good = before.is_good();
  const Paired fitted = fitted_part(poses);
  std::vector<Repair> candidates;
  add_scale(candidates, fitted);
  if (before.has_rotations) {
    add_bodies(candidates, fitted);
    add_conventions(candidates);
  } else if (has_positions_only) {
    add_antenna(candidates, fitted);
  }
  const bool has_same_sense = before.has_rotations && have_same_sense(poses);
  const Repair* best = nullptr;
  Improvement gained;
  double largest = 0.0;
  for (const Repair& repair : candidates) {
    const bool is_known = std::ranges::count(found, repair.fault, &InputFinding::fault) > 0;
    if (is_known || (is_good && !repair.is_lever_arm)) continue;
    Paired changed = poses;
    repair.apply(changed);
    const Agreement after = agreement(changed);
    if (spoils_motions(before, after)) continue;
    if (repair.mirrors_poses && has_same_sense && !mends_motions(before, after)) continue;
    const double gain = before.cost() - after.cost() - repair.penalty;
    if (gain < std::max(largest, repair.is_lever_arm ? kLeastOfLeverArm : kLeastGain)) continue;
    Improvement change = improvement(before, after);
    if (change.ratio > (repair.is_lever_arm ? most_of_lever_arm : kMostAfter)) continue;
    largest = gain;
    best = &repair;
    gained = std::move(change);
  }
  if (best == nullptr) return std::nullopt;
  best->apply(poses);
  return InputFinding{
      best->fault, best->what + ": " + gained.text, best->fix, 1.0 - gained.ratio, best->value};
}

}  // namespace loopbench::metrics
