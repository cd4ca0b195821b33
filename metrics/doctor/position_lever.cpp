#include "metrics/doctor/position_lever.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "datasets/core/so3.hpp"
#include "metrics/doctor/agreement.hpp"

namespace loopbench::metrics {
namespace {

/// Unknowns: rotation, position and logarithm of the scale of the world, lever arm.
constexpr Eigen::Index kWorld = 7, kUnknowns = 10;
using LeverNormal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using LeverVector = Eigen::Matrix<double, kUnknowns, 1>;
constexpr int kLeverParts = 20;

struct LeverEquations {
  LeverNormal normal = LeverNormal::Zero();
  LeverVector right = LeverVector::Zero();
  std::vector<LeverVector> parts = std::vector<LeverVector>(kLeverParts, LeverVector::Zero());
};

LeverEquations equations_at(const Paired& poses, const Eigen::Affine3d& world, const Vector3& arm) {
  LeverEquations out;
  const double scale = std::cbrt(world.linear().determinant());
  const Matrix3 rotation = world.linear() / scale;
  const std::size_t n = poses.estimate.size();
  Vector3 middle = Vector3::Zero();
  for (const auto& [stamp, pose] : poses.estimate) {
    middle += world * pose.translation / static_cast<double>(n);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Pose& pose = poses.estimate[i].world_from_body;
    // The arm is in the reference's scale.
    const Matrix3 of_arm = rotation * pose.rotation.toRotationMatrix();
    const Vector3 expected = world * pose.translation + of_arm * arm;
    Eigen::Matrix<double, 3, kUnknowns> row;
    row.leftCols<3>() = -hat(expected - middle);
    row.middleCols<3>(3).setIdentity();
    row.col(6) = world * pose.translation - middle;
    row.rightCols<3>() = of_arm;
    const Vector3 residual = poses.reference[i].world_from_body.translation - expected;
    const LeverVector right = row.transpose() * residual;
    out.normal += row.transpose() * row;
    out.right += right;
    out.parts[i * kLeverParts / n] += right;
  }
  return out;
}

}  // namespace

std::optional<PositionLever> position_lever(const Paired& poses) {
  constexpr int kRounds = 10;
  constexpr double kConverged = 1e-6, kLeastInformation = 1e-3, kDeviations = 3.0;
  if (poses.estimate.size() < kFewestCommonPoses) return std::nullopt;
  Eigen::Affine3d world = similarity(poses);
  Vector3 arm = Vector3::Zero();
  LeverEquations found;
  Matrix3 axes = Matrix3::Zero();
  Vector3 information = Vector3::Zero();
  LeverNormal inverse;
  for (int round = 0; round < kRounds; ++round) {
    found = equations_at(poses, world, arm);
    // Directions of the arm that the rotations determine, beside those of the world.
    LeverNormal normal = found.normal;
    normal.diagonal().array() += 1e-9 * normal.trace();
    const Eigen::Matrix<double, kWorld, kWorld> of_world = normal.topLeftCorner<kWorld, kWorld>();
    const Matrix3 left = normal.bottomRightCorner<3, 3>() -
                         normal.bottomLeftCorner<3, kWorld>() *
                             of_world.ldlt().solve(normal.topRightCorner<kWorld, 3>());
    const Eigen::SelfAdjointEigenSolver<Matrix3> solver(left);
    axes = solver.eigenvectors();
    information = solver.eigenvalues();
    if (!(information[2] > kLeastInformation * static_cast<double>(poses.estimate.size())))
      return std::nullopt;
    LeverNormal used = LeverNormal::Identity();
    Matrix3 known = Matrix3::Zero();
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (information[k] > kLeastInformation * information[2])
        known += axes.col(k) * axes.col(k).transpose();
    }
    used.bottomRightCorner<3, 3>() = known;
    LeverNormal reduced = used * found.normal * used;
    reduced.diagonal().array() += 1e-12 * found.normal.trace();
    inverse = used * reduced.inverse() * used;
    const LeverVector change = inverse * found.right;
    const double scale = std::exp(change[6]);
    Vector3 middle = Vector3::Zero();
    for (const auto& [stamp, pose] : poses.estimate) {
      middle += world * pose.translation / static_cast<double>(poses.estimate.size());
    }
    const Matrix3 turned = exp_so3(change.head<3>()).toRotationMatrix();
    Eigen::Affine3d next = world;
    next.linear() = scale * turned * world.linear();
    next.translation() =
        scale * (turned * (world.translation() - middle)) + middle + change.segment<3>(3);
    world = next;
    arm += change.tail<3>();
    if (change.tail<3>().norm() < kConverged * (1.0 + arm.norm())) break;
  }
  LeverNormal scatter = LeverNormal::Zero();
  for (const LeverVector& part : found.parts) scatter += part * part.transpose();
  const Matrix3 covariance =
      (inverse * scatter * inverse).bottomRightCorner<3, 3>() * kLeverParts / (kLeverParts - 1.0);
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(covariance);
  PositionLever out;
  Vector3 variance = Vector3::Zero();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Vector3 axis = solver.eigenvectors().col(k);
    const double square = std::max(0.0, solver.eigenvalues()[k]), along = axis.dot(arm);
    if (along * along <= kDeviations * kDeviations * square) continue;
    out.arm += along * axis;
    variance += square * axis.cwiseAbs2();
  }
  if (!(out.arm.norm() > 0.0)) return std::nullopt;
  out.deviation = variance.cwiseSqrt();
  return out;
}

}  // namespace loopbench::metrics
