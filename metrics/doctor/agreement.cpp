#include "metrics/doctor/agreement.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "datasets/core/align_points.hpp"
#include "datasets/core/closest_rotation.hpp"
#include "metrics/alignment/hand_eye.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/numerics/average.hpp"
#include "metrics/pairing/motion.hpp"

namespace loopbench::metrics {
namespace {

constexpr double kFloor = 0.02;  // of errors: no evidence below [-], [rad]

/// Twenty blocks, alternately for fits and for tests.
bool is_fitted(std::size_t index, std::size_t size) {
  constexpr std::size_t kBlocks = 20;
  return index * kBlocks / std::max<std::size_t>(1, size) % 2 == 0;
}

Paired part_of(const Paired& poses, bool fitted) {
  Paired out;
  for (std::size_t i = 0; i < poses.estimate.size(); ++i) {
    if (is_fitted(i, poses.estimate.size()) != fitted) continue;
    out.reference.push_back(poses.reference[i]);
    out.estimate.push_back(poses.estimate[i]);
  }
  return out;
}

Eigen::Matrix3Xd positions(const Trajectory& list) {
  Eigen::Matrix3Xd out(3, list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    out.col(static_cast<Eigen::Index>(i)) = list[i].world_from_body.translation;
  }
  return out;
}

bool is_line(const Trajectory& list) {
  constexpr double kLeastWidth = 0.03;  // over the length; a corridor's is that of its noise
  Eigen::Matrix3Xd centred = positions(list);
  centred.colwise() -= centred.rowwise().mean().eval();
  Matrix3 scatter = Matrix3::Zero();
  for (const auto& position : centred.colwise()) scatter += position * position.transpose();
  const Vector3 ascending =
      Eigen::SelfAdjointEigenSolver<Matrix3>(scatter, Eigen::EigenvaluesOnly).eigenvalues();
  return ascending[1] <= kLeastWidth * kLeastWidth * ascending[2];
}

/// Motions in body frames over short intervals that begin in the part for fits, or for tests.
std::vector<RelativePosePair> motions_of(const Paired& poses, bool fitted) {
  std::vector<RelativePosePair> out;
  const std::size_t n = poses.estimate.size();
  for (const std::size_t step : {n / 200 + 1, n / 40 + 1}) {
    for (std::size_t i = 0; i + step < n; ++i) {
      if (is_fitted(i, n) != fitted) continue;
      const auto motion = [&](const Trajectory& list) {
        return relative_pose(list[i].world_from_body, list[i + step].world_from_body);
      };
      out.push_back({motion(poses.reference), motion(poses.estimate)});
    }
  }
  return out;
}

/// Constant rotation of the body that maps the estimate's motions to the reference's; displacements
/// and rotations have equal weights.
Matrix3 body_of(const std::vector<RelativePosePair>& motions) {
  Matrix3 sum = Matrix3::Zero();
  const auto add = [&](auto part) {
    Matrix3 product = Matrix3::Zero();
    double of_reference = 0.0, of_estimate = 0.0;
    for (const auto& [reference, estimate] : motions) {
      const Vector3 a = part(reference), b = part(estimate);
      product += a * b.transpose();
      of_reference += a.squaredNorm();
      of_estimate += b.squaredNorm();
    }
    const double norm = std::sqrt(of_reference * of_estimate);
    if (norm > 0.0) sum += product / norm;
  };
  add([](const Pose& motion) { return motion.translation; });
  add([](const Pose& motion) { return log_so3(motion.rotation); });
  return closest_rotation(sum);
}

void compare_motions(const Paired& poses, Agreement& out) {
  const std::vector<RelativePosePair> fitted = motions_of(poses, true);
  const Matrix3 body = body_of(fitted);
  double common = 0.0, of_estimate = 0.0;
  for (const auto& [reference, estimate] : fitted) {
    common += reference.translation.dot(body * estimate.translation);
    of_estimate += estimate.translation.squaredNorm();
  }
  const double scale = of_estimate > 0.0 ? std::max(0.0, common / of_estimate) : 1.0;
  double error_squares = 0.0, squares = 0.0;
  std::vector<double> errors, lengths, angles;
  for (const auto& [reference, estimate] : motions_of(poses, false)) {
    errors.push_back((reference.translation - scale * (body * estimate.translation)).norm());
    lengths.push_back(reference.translation.norm());
    const Vector3 rotated = log_so3(reference.rotation);
    angles.push_back((rotated - body * log_so3(estimate.rotation)).norm());
    error_squares += angles.back() * angles.back();
    squares += rotated.squaredNorm();
  }
  const double length = median_value(std::move(lengths));
  if (length > 0.0) out.displacement = median_value(std::move(errors)) / length;
  if (squares > 0.0) out.turning = std::sqrt(error_squares / squares);
  out.usual_turning = median_value(std::move(angles));
}

}  // namespace

Rotation body_rotation(const Paired& poses) {
  return Rotation(body_of(motions_of(poses, true))).conjugate();
}

Paired fitted_part(const Paired& poses) { return part_of(poses, true); }

double Agreement::cost() const {
  return std::log(position / std::max(1e-9, spread) + kFloor) + std::log(displacement + kFloor) +
         std::log(turning + kFloor) + std::log(rotation + kFloor);
}

bool Agreement::is_good() const {
  constexpr double kSmall = 0.08;
  const bool has_small_motions = displacement < kSmall && turning < kSmall;
  return position < kSmall * spread &&
         (!has_rotations || (has_small_motions && (is_line || rotation < kSmall)));
}

double largest_rotation_angle(const Trajectory& poses) {
  double out = 0.0;
  for (const StampedPose& pose : poses) {
    out = std::max(
        out, angle_between(pose.world_from_body.rotation, poses.front().world_from_body.rotation));
  }
  return out;
}

Eigen::Affine3d similarity(const Paired& poses) {
  return Eigen::Affine3d(align_points(positions(poses.estimate), positions(poses.reference), true));
}

double position_error(const Paired& poses, const Eigen::Affine3d& reference_from_estimate) {
  double squares = 0.0;
  for (std::size_t i = 0; i < poses.estimate.size(); ++i) {
    squares += (poses.reference[i].world_from_body.translation -
                reference_from_estimate * poses.estimate[i].world_from_body.translation)
                   .squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(poses.estimate.size()));
}

Agreement agreement(const Paired& poses) {
  Agreement out;
  if (poses.estimate.size() < kFewestCommonPoses) return out;
  const Paired fitted = fitted_part(poses), tested = part_of(poses, false);
  const Eigen::Affine3d rigid(
      align_points(positions(fitted.estimate), positions(fitted.reference), false));
  out.position = position_error(tested, rigid);
  out.spread = spread_of(tested.reference.size(), [&](std::size_t i) -> const Vector3& {
    return tested.reference[i].world_from_body.translation;
  });
  out.has_rotations = std::min(largest_rotation_angle(poses.reference),
                               largest_rotation_angle(poses.estimate)) > kLeastRotation;
  if (!out.has_rotations) return out;
  compare_motions(poses, out);
  out.is_line = is_line(fitted.reference) && is_line(fitted.estimate);
  if (out.is_line) return out;
  std::vector<double> angles;
  for (std::size_t i = 0; i < tested.estimate.size(); ++i) {
    angles.push_back(
        angle_between(tested.reference[i].world_from_body.rotation,
                      Rotation(rigid.linear()) * tested.estimate[i].world_from_body.rotation));
  }
  out.rotation = median_value(std::move(angles));
  return out;
}

Improvement improvement(const Agreement& before, const Agreement& after) {
  constexpr double kSmall = 1e-3;  // smaller errors are numerical
  Improvement out;
  const auto compare = [&](const char* what,
                           double Agreement::*error,
                           double floor,
                           double factor,
                           const char* unit) {
    const double was = before.*error, is = after.*error, ratio = (is + floor) / (was + floor);
    if (!(ratio < out.ratio)) return;
    out = {fmt::format("{} {:.3g} -> {:.3g} {}", what, factor * was, factor * is, unit), ratio};
  };
  compare("position error", &Agreement::position, kSmall * before.spread, 1.0, "m");
  compare("rotation error", &Agreement::rotation, 0.5 / kDegrees, kDegrees, "deg");
  if (out.ratio < 0.5) return out;  // what users see
  compare("error of displacements in body frames", &Agreement::displacement, kSmall, 100.0, "%");
  compare("error of relative rotations", &Agreement::turning, kSmall, 100.0, "%");
  compare(
      "median error of relative rotations", &Agreement::usual_turning, kNoNoise, kDegrees, "deg");
  return out;
}

}  // namespace loopbench::metrics
