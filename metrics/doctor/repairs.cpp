#include "metrics/doctor/repairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/checks/extrinsic_offset.hpp"
#include "metrics/doctor/signed_axes.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

using Change = std::function<Pose(const Pose&)>;

std::function<void(CommonPoses&)> to_each(bool of_reference, const Change& change) {
  return [=](CommonPoses& poses) {
    for (Pose& pose : of_reference ? poses.reference : poses.estimate) pose = change(pose);
  };
}

const char* name_of(bool of_reference) { return of_reference ? "reference" : "estimate"; }
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
void add_convention(std::vector<Proposal>& to,
                    Fault fault,
                    const char* what,
                    const char* option,
                    double penalty,
                    const Change& change) {
  for (const bool of_reference : {false, true}) {
    const Repair repair{fault,
                        fmt::format(fmt::runtime(what), name_of(of_reference)),
                        fmt::format("traj transform {} {}", file_of(of_reference), option),
                        of_reference ? 1.0 : 0.0,
                        penalty + (of_reference ? 0.02 : 0.0),
                        to_each(of_reference, change)};
    to.emplace_back([=](const CommonPoses& poses) -> std::optional<Repair> {
      if (!has_rotations(poses.reference) || !has_rotations(poses.estimate)) return std::nullopt;
      return repair;
    });
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
void add_axes(std::vector<Proposal>& to) {
  constexpr double kPenalty = 0.05;  // of each axis that moves
  for (const Matrix3& axes : signed_axes()) {
    const double distance = (axes - Matrix3::Identity()).squaredNorm();
    const Repair repair{Fault::axes,
                        axes_text(axes) + " of the estimate's positions",
                        "traj transform EST --axes=" + axes_option(axes),
                        distance,
                        kPenalty * distance,
                        to_each(false, [axes](const Pose& p) -> Pose {
                          return {p.rotation, axes * p.translation};
                        })};
    to.emplace_back([=](const CommonPoses& poses) -> std::optional<Repair> {
      if (!has_rotations(poses.reference) || !has_rotations(poses.estimate)) return std::nullopt;
      return repair;
    });
  }
}

/// Millimetres or centimetres, or an arbitrary scale.
std::optional<Repair> scale_repair(const CommonPoses& poses) {
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
std::optional<Repair> body_rotation_repair(const CommonPoses& poses) {
  constexpr double kLeast = 30.0 / kDegrees, kVaries = 20.0 / kDegrees, kPenalty = 0.7;
  if (!has_rotations(poses.reference) || !has_rotations(poses.estimate)) return std::nullopt;
  const auto varies = std::ranges::count_if(poses.reference, [&](const Pose& pose) {
    return angle_between(pose.rotation, poses.reference.front().rotation) > kVaries;
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

std::optional<Repair> lever_arm_repair(const CommonPoses& poses) {
  constexpr double kExplained = 0.5, kPenalty = 0.1;
  if (!has_rotations(poses.reference) || !has_rotations(poses.estimate)) return std::nullopt;
  Trajectory reference, estimate;
  for (std::size_t i = 0; i < poses.stamps.size(); ++i) {
    reference.push_back({poses.stamps[i], poses.reference[i]});
    estimate.push_back({poses.stamps[i], poses.estimate[i]});
  }
  const auto found = extrinsic_offset(reference, estimate, ExtrinsicOffsetOptions{});
  if (!found || found->fit.lever_arm_explained < kExplained) return std::nullopt;
  const Pose body = found->fit.body_from_reference;
  return Repair{
      Fault::lever_arm,
      fmt::format("the reference is that of a body {:.3g} m away", body.translation.norm()),
      fmt::format("--ref-body={}", body_option(body)),
      body.translation.norm(),
      kPenalty,
      to_each(false, [body](const Pose& p) { return p * body; })};
}

std::vector<Proposal> all_proposals() {
  std::vector<Proposal> out;
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
  out.emplace_back(scale_repair);
  out.emplace_back(body_rotation_repair);
  out.emplace_back(lever_arm_repair);
  return out;
}

/// Whether nothing is wrong but drift.
bool agrees(const Agreement& a) {
  constexpr double kSmall = 0.08, kSmallAngle = 5.0 / kDegrees;
  return a.position < kSmall * a.spread && a.displacement < kSmall && a.turning < kSmall &&
         a.rotation < kSmallAngle;
}

CommonPoses thinned(const CommonPoses& poses, std::size_t most) {
  CommonPoses out;
  const std::size_t step = (poses.stamps.size() + most - 1) / most;
  for (std::size_t i = 0; i < poses.stamps.size(); i += step) {
    out.reference.push_back(poses.reference[i]);
    out.estimate.push_back(poses.estimate[i]);
    out.stamps.push_back(poses.stamps[i]);
  }
  return out;
}

}  // namespace

const std::vector<Proposal>& proposals() {
  static const std::vector<Proposal> all = all_proposals();
  return all;
}

std::optional<Proven> best_repair(const CommonPoses& poses) {
  constexpr double kLeastGain = 0.7;  // a factor of 2 in the errors
  constexpr double kLeastOfLeverArm = 0.2;
  constexpr double kMostRatio = 0.75;
  constexpr std::size_t kMostCompared = 300;  // for the choice among all
  if (poses.stamps.size() < kFewestCommonPoses) return std::nullopt;
  const CommonPoses few = thinned(poses, kMostCompared), fitted = fitted_part(poses);
  const Agreement before = agreement(poses), before_of_few = agreement(few);
  const bool is_good = agrees(before);
  std::vector<std::pair<double, const Proposal*>> gains;
  for (const Proposal& proposal : proposals()) {
    const std::optional<Repair> repair = proposal(fitted);
    if (!repair || (is_good && repair->fault != Fault::lever_arm)) continue;
    CommonPoses changed = few;
    repair->apply(changed);
    const double gain = before_of_few.cost() - agreement(changed).cost() - repair->penalty;
    if (gain > (repair->fault == Fault::lever_arm ? kLeastOfLeverArm : kLeastGain))
      gains.emplace_back(-gain, &proposal);
  }
  std::ranges::sort(gains, {}, [](const auto& each) { return each.first; });
  for (const auto& [gain, proposal] : gains) {
    const std::optional<Repair> repair = (*proposal)(fitted);
    CommonPoses changed = poses;
    repair->apply(changed);
    const Agreement after = agreement(changed);
    const Improvement gained = improvement(before, after);
    const bool is_lever_arm = repair->fault == Fault::lever_arm;
    if (before.cost() - after.cost() < (is_lever_arm ? kLeastOfLeverArm : kLeastGain) ||
        gained.ratio > kMostRatio) {
      continue;
    }
    if (std::optional<Repair> final = (*proposal)(poses)) return Proven{std::move(*final), gained};
  }
  return std::nullopt;
}

}  // namespace loopbench::metrics
