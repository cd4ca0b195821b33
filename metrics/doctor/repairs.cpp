#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "metrics/checks/extrinsic_offset.hpp"
#include "metrics/doctor/pair_checks.hpp"
#include "metrics/doctor/signed_axes.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

struct Repair {
  Fault::Name fault;
  std::string what;    ///< "quaternions of the estimate in the order w x y z"
  std::string fix;     ///< a command or an option
  double value = 0.0;  ///< see InputFinding::value
  /// Subtracted from the gain in Agreement::cost(): of two repairs that fit alike, the simpler one
  /// is chosen.
  double penalty = 0.0;
  std::function<void(Paired&)> apply;
};

using Change = std::function<Pose(const Pose&)>;

std::function<void(Paired&)> to_each(bool of_reference, const Change& change) {
  return [=](Paired& poses) {
    for (auto& [stamp, pose] : of_reference ? poses.reference : poses.estimate) pose = change(pose);
  };
}

const char* file_of(bool of_reference) { return of_reference ? "REF" : "EST"; }

Pose read_as_wxyz(const Pose& p) {
  const Rotation& q = p.rotation;
  return {Rotation(q.x(), q.y(), q.z(), q.w()), p.translation};
}

Pose read_as_xyzw(const Pose& p) {
  const Rotation& q = p.rotation;
  return {Rotation(q.z(), q.w(), q.x(), q.y()), p.translation};
}

Pose with_inverse_rotation(const Pose& p) { return {p.rotation.conjugate(), p.translation}; }
Pose inverted(const Pose& p) { return p.inverse(); }

/// A repair without parameters, of either file.
void add_convention(std::vector<Repair>& to,
                    Fault::Name fault,
                    const char* what,
                    const char* option,
                    double penalty,
                    const Change& change) {
  for (const bool of_reference : {false, true}) {
    to.push_back({fault,
                  fmt::format(fmt::runtime(what), of_reference ? "reference" : "estimate"),
                  fmt::format("traj transform {} {}", file_of(of_reference), option),
                  of_reference ? 1.0 : 0.0,
                  penalty + (of_reference ? 0.02 : 0.0),
                  to_each(of_reference, change)});
  }
}

std::string axes_text(const Matrix3& axes) {
  std::string option = axes_option(axes);
  if (option == "y,x,z") return "exchanging x and y";
  if (option == "z,y,x") return "exchanging x and z";
  if (option == "x,z,y") return "exchanging y and z";
  std::ranges::replace(option, ',', ' ');
  return "taking " + option + " as x y z";
}

/// The signed permutations of the estimate's positions.
void add_axes(std::vector<Repair>& to) {
  constexpr double kPenalty = 0.05;  // of each axis that moves
  for (const Matrix3& axes : signed_axes()) {
    const double distance = (axes - Matrix3::Identity()).squaredNorm();
    to.push_back({Fault::axes,
                  axes_text(axes) + " of the estimate's positions",
                  "traj transform EST --axes=" + axes_option(axes),
                  distance,
                  kPenalty * distance,
                  to_each(false, [axes](const Pose& p) -> Pose {
                    return {p.rotation, axes * p.translation};
                  })});
  }
}

/// Millimetres or centimetres, or an arbitrary scale.
std::optional<Repair> scale_repair(const Paired& poses) {
  constexpr double kUnitTolerance = 0.12, kLeastScale = 0.1, kPenalty = 0.2;
  const double scale = fit_positions(poses).scale;
  if (std::abs(std::log(scale)) < kLeastScale) return std::nullopt;
  Repair out{Fault::scale,
             fmt::format("the estimate has scale {:.3f}", 1.0 / scale),
             "--align sim3",
             scale,
             kPenalty,
             to_each(false, [scale](const Pose& p) -> Pose {
               return {p.rotation, scale * p.translation};
             })};
  for (const double unit : {1000.0, 100.0, 0.01, 0.001}) {
    if (std::abs(std::log(scale * unit)) > kUnitTolerance) continue;
    const bool is_millimetre = unit == 1000.0 || unit == 0.001;
    out.fault = Fault::length_unit;
    out.what = fmt::format("distances in the estimate are {:.4g} times those of the reference",
                           1.0 / scale);
    out.fix = fmt::format("traj transform {} --scale {} ({} to metres)",
                          file_of(unit < 1.0),
                          is_millimetre ? "0.001" : "0.01",
                          is_millimetre ? "millimetres" : "centimetres");
    out.value = 1.0 / scale;
  }
  return out;
}

/// Axes of another body. Only where rotations vary: the alignment of a straight path is ambiguous.
std::optional<Repair> body_rotation_repair(const Paired& poses) {
  constexpr double kLeast = 30.0 / kDegrees, kVaries = 20.0 / kDegrees, kPenalty = 0.7;
  const Rotation& first = poses.reference.front().world_from_body.rotation;
  const auto varies = std::ranges::count_if(poses.reference, [&](const StampedPose& pose) {
    return angle_between(pose.world_from_body.rotation, first) > kVaries;
  });
  if (10 * static_cast<std::size_t>(varies) < poses.reference.size()) return std::nullopt;
  const Rotation body = fit_body(poses);
  const double angle = angle_between(body, Rotation::Identity());
  if (angle < kLeast) return std::nullopt;
  return Repair{Fault::body_rotation,
                fmt::format("the reference's body is rotated by {:.1f} deg", kDegrees * angle),
                fmt::format("--ref-body={}", body_option({body, Vector3::Zero()})),
                angle,
                kPenalty,
                to_each(false, [body](const Pose& p) -> Pose {
                  return {p.rotation * body, p.translation};
                })};
}

std::optional<Repair> lever_arm_repair(const Paired& poses) {
  constexpr double kExplained = 0.5, kPenalty = 0.1, kPenaltyOfRotation = 0.9;
  const auto found = extrinsic_offset(poses.reference, poses.estimate, ExtrinsicOffsetOptions{});
  if (!found || found->fit.lever_arm_explained < kExplained) return std::nullopt;
  const Pose body = found->fit.body_from_reference;
  return Repair{
      Fault::lever_arm,
      fmt::format("the reference is that of a body {:.3g} m away", body.translation.norm()),
      fmt::format("--ref-body={}", body_option(body)),
      body.translation.norm(),
      kPenalty + (found->fit.rotation_explained > 0.0 ? kPenaltyOfRotation : 0.0),
      to_each(false, [body](const Pose& p) { return p * body; })};
}

/// Repairs with parameters, which fit `poses`.
std::vector<Repair> fitted_repairs(const Paired& poses) {
  std::vector<Repair> out;
  const auto add = [&](std::optional<Repair> repair) {
    if (repair) out.push_back(std::move(*repair));
  };
  add(scale_repair(poses));
  if (!has_rotations(poses)) return out;
  add(body_rotation_repair(poses));
  add(lever_arm_repair(poses));
  return out;
}

/// Repairs without parameters.
std::vector<Repair> conventions() {
  std::vector<Repair> out;
  add_convention(out,
                 Fault::quaternion_order,
                 "quaternions of the {} in the order w x y z",
                 "--quaternion-order wxyz",
                 0.0,
                 read_as_wxyz);
  add_convention(out,
                 Fault::quaternion_order,
                 "quaternions of the {} in the order x y z w",
                 "--quaternion-order xyzw",
                 0.05,
                 read_as_xyzw);
  add_convention(out,
                 Fault::conjugated,
                 "inverting the rotations of the {}, but not the positions",
                 "--conjugate",
                 0.1,
                 with_inverse_rotation);
  add_convention(
      out, Fault::inverted_poses, "inverting the poses of the {}", "--invert-poses", 0.0, inverted);
  add_axes(out);
  return out;
}

/// Whether nothing is wrong but drift.
bool agrees(const Agreement& a) {
  constexpr double kSmall = 0.08, kSmallAngle = 5.0 / kDegrees;
  return a.position < kSmall * a.spread && a.displacement < kSmall && a.turning < kSmall &&
         a.rotation < kSmallAngle;
}

}  // namespace

std::optional<InputFinding> apply_best_repair(Paired& poses) {
  constexpr double kLeastGain = 0.7;  // a factor of 2 in the errors
  constexpr double kMostRatio = 0.75;
  constexpr double kLeastOfLeverArm = 0.2, kMostOfLeverArm = 0.6;  // drift resembles lever arms
  const Agreement before = agreement(poses);
  const bool is_good = agrees(before);
  std::vector<Repair> candidates = fitted_repairs(fitted_part(poses));
  if (before.has_rotations) std::ranges::move(conventions(), std::back_inserter(candidates));
  Repair best;
  Improvement gained;
  double largest = 0.0;
  for (Repair& repair : candidates) {
    const bool is_lever_arm = repair.fault == Fault::lever_arm;
    if (is_good && !is_lever_arm) continue;
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
    if (repair.fault == best.fault) best = std::move(repair);
  }
  best.apply(poses);
  return InputFinding{
      best.fault, best.what + ": " + gained.text, best.fix, 1.0 - gained.ratio, best.value};
}

}  // namespace loopbench::metrics
