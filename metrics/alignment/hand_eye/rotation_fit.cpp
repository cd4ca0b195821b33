#include "metrics/alignment/hand_eye/rotation_fit.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <numbers>

namespace loopbench::metrics {
namespace {

constexpr double kExplains = 0.5;  // share of the squares, to accept
constexpr double kMinRotation =
    5.0 * std::numbers::pi / 180.0;   // below: a tilt, unobservable in 2-D
constexpr double kSecondAxis = 0.02;  // of the first singular value
constexpr double kNothing = 1e-18;    // of the squared motion; below it nothing is explained

/// Sums of squared rotations and displacements, each normalised by its own size.
struct MotionSizes {
  double rotations = 0.0;
  double translations = 0.0;
};

MotionSizes sizes_of(const std::vector<RelativePosePair>& pairs) {
  MotionSizes out;
  for (const auto& [q, z] : pairs) {
    out.rotations += log_so3(z.rotation).squaredNorm();
    out.translations += q.translation.squaredNorm() + z.translation.squaredNorm();
  }
  return out;
}

double difference(const std::vector<RelativePosePair>& pairs,
                  const MotionSizes& sizes,
                  const Rotation& rotation) {
  double out = 0.0;
  for (const auto& [q, z] : pairs) {
    out += (log_so3(z.rotation) - rotation * log_so3(q.rotation)).squaredNorm() / sizes.rotations;
    if (sizes.translations > 0.0)
      out += (z.translation - rotation * q.translation).squaredNorm() / sizes.translations;
  }
  return out;
}

/// The rotation by Kabsch's method.
Rotation rotation_of(const Eigen::JacobiSVD<Matrix3>& svd) {
  Matrix3 flip = Matrix3::Identity();
  flip(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  Rotation rotation(Matrix3(svd.matrixU() * flip * svd.matrixV().transpose()));
  if (rotation.w() < 0.0) rotation.coeffs() *= -1.0;  // the same rotation with w >= 0, as in files
  return rotation.normalized();
}

}  // namespace

RotationFit fit_rotation(const std::vector<RelativePosePair>& pairs) {
  const MotionSizes sizes = sizes_of(pairs);
  Matrix3 rotations = Matrix3::Zero();
  Matrix3 translations = Matrix3::Zero();
  for (const auto& [q, z] : pairs) {
    rotations += log_so3(z.rotation) * log_so3(q.rotation).transpose() / sizes.rotations;
    if (sizes.translations > 0.0)
      translations += z.translation * q.translation.transpose() / sizes.translations;
  }
  constexpr unsigned kFullMatrices = Eigen::ComputeFullU | Eigen::ComputeFullV;
  Eigen::JacobiSVD<Matrix3> svd(rotations, kFullMatrices);
  // Displacements also depend on the unknown lever arm: use them only if all rotations share an
  // axis.
  const bool about_one_axis = svd.singularValues()[1] <= kSecondAxis * svd.singularValues()[0];
  if (about_one_axis) svd.compute(rotations + translations, kFullMatrices);
  const Rotation rotation = rotation_of(svd);
  const double before = difference(pairs, sizes, Rotation::Identity());
  if (before <= kNothing || log_so3(rotation).norm() < kMinRotation) return {};
  const double explained = 1.0 - difference(pairs, sizes, rotation) / before;
  if (explained < kExplains) return {};
  return {rotation, explained};
}

}  // namespace loopbench::metrics
