#include "metrics/doctor/frame_checks.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/frame_fit.hpp"
#include "metrics/doctor/unit_checks.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

constexpr std::size_t kMostPoses = 2000;

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

bool has_rotations(const std::vector<Pose>& poses) {
  return std::ranges::any_of(poses, [&](const Pose& pose) {
    return angle_between(pose.rotation, poses.front().rotation) > 0.05;
  });
}

/// A hypothesis about one of the trajectories.
struct Hypothesis {
  Fault fault;
  std::string what;  ///< "quaternions are w x y z"
  Change change;
};

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
      fmt::format("invert each pose of the {} (body_from_world -> world_from_body)",
                  name_of(is_reference)),
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
  double disagreement = 0.0;  ///< with the positions [rad]
};

/// The hypotheses about either trajectory, the one that agrees best with the positions first.
std::vector<Candidate> candidates(const CommonPoses& poses, const PositionFit& positions) {
  static const Hypothesis kHypotheses[] = {
      {Fault::quaternion_order, "the quaternions are w x y z, read as x y z w,", reordered},
      {Fault::quaternion_order, "the quaternions are x y z w, read as w x y z,", reordered_back},
      {Fault::conjugated,
       "the rotations are inverted, but not the positions,",
       with_inverse_rotation}};
  std::vector<Candidate> out;
  for (const Hypothesis& hypothesis : kHypotheses) {
    for (const bool of_reference : {false, true}) {
      const ConstantRotations fit = fit_rotations(
          of_reference ? changed(poses.reference, hypothesis.change) : poses.reference,
          of_reference ? poses.estimate : changed(poses.estimate, hypothesis.change));
      out.push_back({&hypothesis, of_reference, fit.residual, disagreement(fit, positions)});
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
    const bool fits = is_bad ? each.residual < kBetter * as_read.residual
                             : each.residual < kBad && each.disagreement < kAgrees &&
                                   each.hypothesis->fault == Fault::quaternion_order;
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
        fmt::format("--{}format euroc reads w x y z; a csv header can name the columns",
                    each.of_reference ? "ref-" : ""),
        is_bad ? 1.0 - each.residual / as_read.residual : 1.0 - each.disagreement / before,
        each.of_reference ? 1.0 : 0.0};
  }
  return std::nullopt;
}

/// The signed permutation of axes that is closest to an orthogonal matrix, and their angle [rad].
struct AxisMap {
  Matrix3 matrix = Matrix3::Zero();
  double angle = 0.0;

  /// "x -y z": where the axes come from.
  std::string text() const {
    std::string out;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        if (matrix(row, column) == 0.0) continue;
        out += std::string(out.empty() ? "" : " ") + (matrix(row, column) < 0.0 ? "-" : "") +
               "xyz"[column];
      }
    }
    return out;
  }
};

AxisMap closest_axes(const Matrix3& orthogonal) {
  AxisMap out;
  Matrix3 rest = orthogonal;
  for (int k = 0; k < 3; ++k) {
    Eigen::Index row = 0, column = 0;
    rest.cwiseAbs().maxCoeff(&row, &column);
    out.matrix(row, column) = orthogonal(row, column) < 0.0 ? -1.0 : 1.0;
    rest.row(row).setZero();
    rest.col(column).setZero();
  }
  const double trace = (out.matrix.transpose() * orthogonal).trace();
  out.angle = std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0));
  return out;
}

/// Positions and rotations that each fit, but with world frames that differ by a signed permutation
/// of axes.
std::optional<InputFinding> check_axes(const ConstantRotations& rotations,
                                       const PositionFit& positions) {
  constexpr double kGood = 15.0 / kDegrees, kGoodPositions = 0.45, kWide = 0.005;
  constexpr double kLeastAngle = 30.0 / kDegrees, kClose = 17.0 / kDegrees;
  if (rotations.residual > kGood || positions.width < kWide) return std::nullopt;
  if (disagreement(rotations, positions) < kLeastAngle) return std::nullopt;
  const Matrix3 left = rotations.left.toRotationMatrix();
  const AxisMap proper = closest_axes(left.transpose() * positions.rotation);
  const AxisMap improper = closest_axes(left.transpose() * positions.reflection);
  const bool is_proper =
      positions.similarity < kGoodPositions && proper.angle < kClose && !proper.matrix.isIdentity();
  const bool is_improper = positions.reflected < kGoodPositions && improper.angle < kClose &&
                           positions.reflected < 1.02 * positions.similarity;
  if (!is_proper && !is_improper) return std::nullopt;
  const bool uses_reflection =
      is_improper && (!is_proper || positions.reflected < 0.8 * positions.similarity);
  const AxisMap& found = uses_reflection ? improper : proper;
  return InputFinding{
      Fault::axes,
      fmt::format("the axes of positions and rotations differ: x y z of one are {} of the other, "
                  "within {:.1f} deg (relative position error {:.3f}, rotation error {:.1f} deg)",
                  found.text(),
                  kDegrees * found.angle,
                  uses_reflection ? positions.reflected : positions.similarity,
                  kDegrees * rotations.residual),
      "exchange or mirror the axes in one of the files",
      std::clamp(1.0 - found.angle / (M_PI / 4), 0.0, 1.0),
      kDegrees * found.angle};
}

}  // namespace

std::vector<InputFinding> check_frames(const Trajectory& reference, const Trajectory& estimate) {
  std::vector<InputFinding> out;
  const CommonPoses poses = common_poses(reference, estimate, 0.0, kMostPoses);
  constexpr std::size_t kFewest = 20;
  if (poses.stamps.size() < kFewest) return out;
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
  } else if (auto mismatch = check_axes(rotations, positions)) {
    out.push_back(*mismatch);
  }
  return out;
}

}  // namespace loopbench::metrics
