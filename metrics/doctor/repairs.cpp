#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "datasets/core/mirrored.hpp"
#include "metrics/checks/extrinsic_offset.hpp"
#include "metrics/doctor/pair_checks.hpp"
#include "metrics/doctor/signed_axes.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

constexpr double kPenalty = 0.1;  // of the gain, for a sign or a parameter that a repair changes

struct Repair {
  Fault::Name fault;
  std::string what;      ///< "quaternions of the estimate in the order w x y z"
  std::string fix;       ///< a command or an option
  double value = 0.0;    ///< see InputFinding::value
  double penalty = 0.0;  ///< of the gain: of two that fit alike, the simpler one is chosen
  std::function<void(Paired&)> apply;
  bool is_lever_arm = false;
};

using Change = std::function<Pose(const Pose&)>;

std::function<void(Paired&)> to_each(bool of_reference, const Change& change) {
  return [=](Paired& poses) {
    for (auto& [stamp, pose] : of_reference ? poses.reference : poses.estimate) pose = change(pose);
  };
}

const char* file_of(bool of_reference) { return of_reference ? "REF" : "EST"; }

/// Conventions of either file.
void add_conventions(std::vector<Repair>& to) {
  struct Convention {
    Fault::Name fault;
    const char* what;
    const char* option;
    double penalty;
    Pose (*change)(const Pose&);
  };
  static constexpr Convention kAll[] = {
      {Fault::quaternion_order,
       "quaternions in the order w x y z",
       "--quaternion-order wxyz",
       0.0,
       [](const Pose& p) -> Pose {
         const Rotation& q = p.rotation;
         return {Rotation(q.x(), q.y(), q.z(), q.w()), p.translation};
       }},
      {Fault::quaternion_order,
       "quaternions, once read as w x y z instead of x y z w,",
       "--quaternion-order wxyz (three times, each moves them by one)",
       kPenalty,
       [](const Pose& p) -> Pose {
         const Rotation& q = p.rotation;
         return {Rotation(q.z(), q.w(), q.x(), q.y()), p.translation};
       }},
      {Fault::inverted_poses,
       "inverting the positions, but not the rotations,",
       "--conjugate, then --invert-poses",
       kPenalty,
       [](const Pose& p) -> Pose {
         return {p.rotation, -(p.rotation * p.translation)};
       }},
      {Fault::inverted_poses,
       "inverting the rotations, but not the positions,",
       "--conjugate",
       kPenalty,
       [](const Pose& p) -> Pose {
         return {p.rotation.conjugate(), p.translation};
       }},
      {Fault::inverted_poses, "inverting the poses", "--invert-poses", 0.0, [](const Pose& p) {
         return p.inverse();
       }}};
  for (const auto& [fault, what, option, penalty, change] : kAll) {
    for (const bool of_reference : {false, true}) {
      to.push_back({fault,
                    fmt::format("{} of the {}", what, of_reference ? "reference" : "estimate"),
                    fmt::format("traj transform {} {}", file_of(of_reference), option),
                    of_reference ? 1.0 : 0.0,
                    penalty + (of_reference ? 0.2 * kPenalty : 0.0),
                    to_each(of_reference, change)});
    }
  }
}

/// The signed permutations of the estimate's positions.
void add_axes(std::vector<Repair>& to) {
  for (const auto& [axes, option] : signed_axes()) {
    const double distance = (axes - Matrix3::Identity()).squaredNorm();
    to.push_back({axes.determinant() < 0.0 ? Fault::mirrored : Fault::axes,
                  "taking " + option + " of the estimate's positions as x,y,z",
                  "traj transform EST --axes=" + option,
                  distance,
                  0.5 * kPenalty * distance,  // of each axis that moves
                  to_each(false, [by = axes](const Pose& p) -> Pose {
                    return {p.rotation, by * p.translation};
                  })});
  }
}

/// Left-handed coordinates.
void add_mirrors(std::vector<Repair>& to) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    to.push_back({Fault::mirrored,
                  "mirroring " + name + " of the estimate's positions and rotations",
                  "traj transform EST --mirror " + name,
                  4.0,
                  2.5 * kPenalty,
                  to_each(false, [axis](const Pose& p) { return mirrored(p, axis); })});
  }
}

/// Millimetres or centimetres, or an arbitrary scale.
void add_scale(std::vector<Repair>& to, const Paired& poses) {
  constexpr double kUnitTolerance = 0.12, kLeastScale = 0.05;
  const double scale = std::cbrt(similarity(poses).linear().determinant());
  if (std::abs(std::log(scale)) < kLeastScale) return;
  const auto scaled = [](bool of_reference, double by) {
    return to_each(of_reference, [by](const Pose& p) -> Pose {
      return {p.rotation, by * p.translation};
    });
  };
  Repair out{Fault::scale,
             fmt::format("the estimate has scale {:.4g}", 1.0 / scale),
             "--align sim3",
             scale,
             2.0 * kPenalty,
             scaled(false, scale)};
  for (const auto& [factor, unit] : {std::pair{0.001, "millimetres"}, {0.01, "centimetres"}}) {
    const bool of_reference = scale > 1.0;
    if (std::abs(std::log(of_reference ? scale * factor : scale / factor)) > kUnitTolerance)
      continue;
    out = {Fault::scale,
           out.what,
           fmt::format("traj transform {} --scale {} ({} to metres){}",
                       file_of(of_reference),
                       factor,
                       unit,
                       of_reference && factor < 0.01 ? ", or EST --scale 1000 (kilometres)" : ""),
           1.0 / scale,
           2.0 * kPenalty,
           scaled(of_reference, of_reference ? 1.0 / scale : scale)};
  }
  to.push_back(std::move(out));
}

/// Axes and lever arm of another body.
void add_bodies(std::vector<Repair>& to, const Paired& poses) {
  constexpr double kLeastAngle = 10.0 / kDegrees, kExplained = 0.5;
  const auto add = [&](bool is_lever_arm,
                       const Pose& by,
                       double value,
                       double penalty,
                       const std::string& what) {
    to.push_back({Fault::other_body,
                  "the reference is that of a body " + what,
                  "--ref-body=" + body_option(by),
                  value,
                  penalty,
                  to_each(false, [by](const Pose& p) { return p * by; }),
                  is_lever_arm});
  };
  const Rotation axes = body_rotation(poses);
  if (const double angle = angle_between(axes, Rotation::Identity()); angle > kLeastAngle) {
    add(false,
        {axes, Vector3::Zero()},
        angle,
        7.0 * kPenalty,
        fmt::format("with axes rotated by {:.1f} deg", kDegrees * angle));
  }
  const auto found = extrinsic_offset(poses.reference, poses.estimate, ExtrinsicOffsetOptions{});
  if (!found) return;
  const Pose& body = found->fit.body_from_reference;
  if (found->fit.lever_arm_explained > kExplained) {
    add(true,
        body,
        body.translation.norm(),
        body.rotation.vec().norm() > 0.0 ? 12.0 * kPenalty : kPenalty,
        fmt::format("{:.3g} m away", body.translation.norm()));
  }
}

/// Repairs with parameters, which fit `poses`.
std::vector<Repair> fitted_repairs(const Paired& poses) {
  std::vector<Repair> out;
  add_scale(out, poses);
  if (has_rotations(poses)) add_bodies(out, poses);
  return out;
}

/// Whether nothing is wrong but drift.
bool agrees(const Agreement& a) {
  constexpr double kSmall = 0.08, kSmallAngle = 5.0 / kDegrees;
  return a.position < kSmall * a.spread && a.displacement < kSmall && a.turning < kSmall &&
         a.rotation < kSmallAngle;
}

}  // namespace

std::optional<InputFinding> apply_best_repair(Paired& poses,
                                              const std::vector<InputFinding>& found) {
  constexpr double kLeastGain = 0.7;  // a factor of 2 in the errors
  constexpr double kMostRatio = 0.75;
  constexpr double kLeastOfLeverArm = 0.2, kMostOfLeverArm = 0.6;  // drift resembles lever arms
  const Agreement before = agreement(poses);
  const bool is_good = agrees(before);
  std::vector<Repair> candidates = fitted_repairs(fitted_part(poses));
  if (before.has_rotations) {
    add_conventions(candidates);
    add_axes(candidates);
    add_mirrors(candidates);
  }
  Repair best;
  Improvement gained;
  double largest = 0.0;
  for (Repair& repair : candidates) {
    const bool is_lever_arm = repair.is_lever_arm;
    const bool is_known = std::ranges::any_of(
        found, [&](const InputFinding& each) { return each.fault == repair.fault; });
    if (is_known || (is_good && !is_lever_arm)) continue;
    Paired changed = poses;
    repair.apply(changed);
    const Agreement after = agreement(changed);
    const double gain = before.cost() - after.cost() - repair.penalty;
    if (gain < std::max(largest, is_lever_arm ? kLeastOfLeverArm : kLeastGain)) continue;
    Improvement change = improvement(before, after);
    if (change.ratio > (is_lever_arm ? kMostOfLeverArm : kMostRatio)) continue;
    largest = gain;
    best = std::move(repair);
    gained = std::move(change);
  }
  if (!best.apply) return std::nullopt;
  for (Repair& repair : fitted_repairs(poses)) {
    if (repair.fault == best.fault && repair.is_lever_arm == best.is_lever_arm)
      best = std::move(repair);
  }
  best.apply(poses);
  return InputFinding{
      best.fault, best.what + ": " + gained.text, best.fix, 1.0 - gained.ratio, best.value};
}

}  // namespace loopbench::metrics
