#include "metrics/doctor/agreement.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "metrics/alignment/hand_eye.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

/// Rotation R that maximises trace(R^T M).
Matrix3 closest_rotation(const Matrix3& m) {
  const Eigen::JacobiSVD<Matrix3> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix3 product = svd.matrixU() * svd.matrixV().transpose();
  const double sign = product.determinant() < 0.0 ? -1.0 : 1.0;
  return svd.matrixU() * Vector3(1.0, 1.0, sign).asDiagonal() * svd.matrixV().transpose();
}

/// Motions in body frames over one interval, of both lists.
struct BodyMotion {
  Vector3 reference_moved, estimate_moved;      // [m]
  Vector3 reference_rotated, estimate_rotated;  // rotation vectors [rad]
  bool is_fitted = false;
};

std::vector<BodyMotion> motions_of(const CommonPoses& poses) {
  std::vector<BodyMotion> out;
  const std::size_t n = poses.stamps.size();
  for (const std::size_t step : {n / 200 + 1, n / 40 + 1}) {
    for (std::size_t i = 0; i + step < n; ++i) {
      const auto moved = [&](const std::vector<Pose>& list) -> Vector3 {
        return list[i].rotation.conjugate() * (list[i + step].translation - list[i].translation);
      };
      const auto rotated = [&](const std::vector<Pose>& list) {
        return log_so3(list[i].rotation.conjugate() * list[i + step].rotation);
      };
      out.push_back({moved(poses.reference),
                     moved(poses.estimate),
                     rotated(poses.reference),
                     rotated(poses.estimate),
                     is_fitted(i, n)});
    }
  }
  return out;
}

/// Constant rotation of the body and scale that map the estimate's motions to the reference's.
void compare_motions(const CommonPoses& poses, Agreement& out) {
  const std::vector<BodyMotion> motions = motions_of(poses);
  const auto product_of = [&](Vector3 BodyMotion::*reference,
                              Vector3 BodyMotion::*estimate) -> Matrix3 {
    Matrix3 product = Matrix3::Zero();
    double of_reference = 0.0, of_estimate = 0.0;
    for (const BodyMotion& each : motions) {
      if (!each.is_fitted) continue;
      product += each.*reference * (each.*estimate).transpose();
      of_reference += (each.*reference).squaredNorm();
      of_estimate += (each.*estimate).squaredNorm();
    }
    const double norm = std::sqrt(of_reference * of_estimate);
    return norm > 0.0 ? Matrix3(product / norm) : Matrix3(product);
  };
  const Matrix3 body =
      closest_rotation(product_of(&BodyMotion::reference_moved, &BodyMotion::estimate_moved) +
                       product_of(&BodyMotion::reference_rotated, &BodyMotion::estimate_rotated));
  double common = 0.0, of_estimate = 0.0;
  for (const BodyMotion& each : motions) {
    if (!each.is_fitted) continue;
    common += each.reference_moved.dot(body * each.estimate_moved);
    of_estimate += each.estimate_moved.squaredNorm();
  }
  const double scale = of_estimate > 0.0 ? std::max(0.0, common / of_estimate) : 1.0;
  std::vector<double> errors, lengths;
  double error_squares = 0.0, squares = 0.0;
  for (const BodyMotion& each : motions) {
    if (each.is_fitted) continue;
    errors.push_back((each.reference_moved - scale * (body * each.estimate_moved)).norm());
    lengths.push_back(each.reference_moved.norm());
    error_squares += (each.reference_rotated - body * each.estimate_rotated).squaredNorm();
    squares += each.reference_rotated.squaredNorm();
  }
  Trajectory reference, estimate;
  for (std::size_t i = 0; i < poses.stamps.size(); ++i) {
    if (is_fitted(i, poses.stamps.size())) continue;
    reference.push_back({poses.stamps[i], poses.reference[i]});
    estimate.push_back({poses.stamps[i], poses.estimate[i]});
  }
  constexpr double kAngle = 6.0 / kDegrees, kLongest = 10.0;  // [s]
  std::vector<double> swings, swing_lengths;
  for (const auto& [q, z] : rotating_intervals(reference, estimate, kAngle, kLongest)) {
    swings.push_back((q.translation - scale * (body * z.translation)).norm());
    swing_lengths.push_back(q.translation.norm());
  }
  if (swings.size() > 5) {
    out.swing = median_value(std::move(swings));
    out.swing_length = median_value(std::move(swing_lengths));
  }
  const double length = median_value(std::move(lengths));
  out.displacement = length > 0.0 ? median_value(std::move(errors)) / length : 0.0;
  out.turning = squares > 0.0 ? std::sqrt(error_squares / squares) : 0.0;
}

}  // namespace

bool is_fitted(std::size_t index, std::size_t size) {
  constexpr std::size_t kBlocks = 20;
  return index * kBlocks / std::max<std::size_t>(1, size) % 2 == 0;
}

CommonPoses fitted_part(const CommonPoses& poses) {
  CommonPoses out;
  for (std::size_t i = 0; i < poses.stamps.size(); ++i) {
    if (!is_fitted(i, poses.stamps.size())) continue;
    out.reference.push_back(poses.reference[i]);
    out.estimate.push_back(poses.estimate[i]);
    out.stamps.push_back(poses.stamps[i]);
  }
  return out;
}

double Agreement::cost() const {
  constexpr double kFloor = 0.02, kFloorOfAngle = 0.05;
  double out = std::log(position / std::max(1e-9, spread) + kFloor);
  if (has_rotations) {
    out += std::log(displacement + kFloor) + std::log(turning + kFloor) +
           std::log(rotation + kFloorOfAngle);
    if (swing_length > 0.0) out += std::log(swing / swing_length + kFloor);
  }
  return out;
}

bool has_rotations(const std::vector<Pose>& poses) {
  return std::ranges::any_of(poses, [&](const Pose& pose) {
    return angle_between(pose.rotation, poses.front().rotation) > kLeastRotation;
  });
}

PositionFit fit_positions(const CommonPoses& poses) {
  PositionFit out;
  const auto n = static_cast<double>(poses.stamps.size());
  for (const Pose& pose : poses.reference) out.mean_reference += pose.translation / n;
  for (const Pose& pose : poses.estimate) out.mean_estimate += pose.translation / n;
  Matrix3 covariance = Matrix3::Zero();
  double variance = 0.0;
  for (std::size_t i = 0; i < poses.stamps.size(); ++i) {
    const Vector3 e = poses.estimate[i].translation - out.mean_estimate;
    covariance += (poses.reference[i].translation - out.mean_reference) * e.transpose() / n;
    variance += e.squaredNorm() / n;
  }
  out.rotation = closest_rotation(covariance);
  const double scale = (out.rotation.transpose() * covariance).trace() / variance;
  if (variance > 0.0 && scale > 0.0) out.scale = scale;
  return out;
}

Rotation fit_body(const CommonPoses& poses) {
  const Rotation world(fit_positions(poses).rotation);
  Matrix3 sum = Matrix3::Zero();
  for (std::size_t i = 0; i < poses.stamps.size(); ++i) {
    sum += ((world * poses.estimate[i].rotation).conjugate() * poses.reference[i].rotation)
               .toRotationMatrix();
  }
  return Rotation(closest_rotation(sum)).normalized();
}

Agreement agreement(const CommonPoses& poses) {
  Agreement out;
  const std::size_t n = poses.stamps.size();
  if (n < kFewestCommonPoses) return out;
  const PositionFit fit = fit_positions(fitted_part(poses));
  const Rotation world(fit.rotation);
  double rigid = 0.0, similar = 0.0, spread = 0.0, count = 0.0;
  std::vector<double> angles;
  for (std::size_t i = 0; i < n; ++i) {
    if (is_fitted(i, n)) continue;
    const Vector3 r = poses.reference[i].translation - fit.mean_reference;
    const Vector3 e = fit.rotation * (poses.estimate[i].translation - fit.mean_estimate);
    rigid += (r - e).squaredNorm();
    similar += (r - fit.scale * e).squaredNorm();
    spread += r.squaredNorm();
    angles.push_back(
        angle_between(poses.reference[i].rotation, world * poses.estimate[i].rotation));
    count += 1.0;
  }
  out.position = std::sqrt(rigid / count);
  out.similarity = std::sqrt(similar / count);
  out.spread = std::sqrt(spread / count);
  out.rotation = median_value(std::move(angles));
  out.has_rotations = has_rotations(poses.reference) && has_rotations(poses.estimate);
  if (out.has_rotations) compare_motions(poses, out);
  return out;
}

Improvement improvement(const Agreement& before, const Agreement& after) {
  constexpr double kSmall = 1e-3;
  Improvement out;
  const auto compare = [&](double was, double is, double floor, const std::string& text) {
    const double ratio = (is + floor) / (was + floor);
    if (ratio < out.ratio) out = {text, ratio};
  };
  compare(before.position,
          after.position,
          kSmall * before.spread,
          fmt::format("position error {:.3g} -> {:.3g} m", before.position, after.position));
  if (!before.has_rotations || !after.has_rotations) return out;
  compare(before.rotation,
          after.rotation,
          0.5 / kDegrees,
          fmt::format("rotation error {:.1f} -> {:.1f} deg",
                      kDegrees * before.rotation,
                      kDegrees * after.rotation));
  if (out.ratio < 0.5) return out;
  compare(before.displacement,
          after.displacement,
          kSmall,
          fmt::format("error of displacements in body frames {:.1f} -> {:.1f} %",
                      100.0 * before.displacement,
                      100.0 * after.displacement));
  compare(before.turning,
          after.turning,
          kSmall,
          fmt::format("error of relative rotations {:.1f} -> {:.1f} %",
                      100.0 * before.turning,
                      100.0 * after.turning));
  compare(
      before.swing,
      after.swing,
      0.02 * before.swing_length,
      fmt::format(
          "error of displacements over rotations {:.3g} -> {:.3g} m", before.swing, after.swing));
  return out;
}

}  // namespace loopbench::metrics
