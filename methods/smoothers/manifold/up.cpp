#include "methods/smoothers/manifold/up.hpp"

#include <Eigen/Eigenvalues>

namespace loopbench::methods::manifold {
namespace {

// Relative eigenvalue gap below which rounding of the input rotates the axis noticeably: the axis
// error is about eps * l2 / (l1 - l0) and moves points at a distance of sqrt(l1) from the axis.
constexpr double kGap = 1e-5;  // fraction of sqrt(l1 l2)

// Returns the first body axis that is not nearly perpendicular to the subspace. At least one of
// three has a component of more than sqrt(1/3) in it.
Vector3 body_axis_in(const Matrix3& projector, const Rotation& world_from_body) {
  Vector3 inside;
  for (const int axis : {2, 1, 0}) {
    inside = projector * (world_from_body * Vector3::Unit(axis));
    if (inside.norm() > 0.5) break;
  }
  return inside.normalized();
}

}  // namespace

Vector3 up_axis(const Trajectory& nodes, UpDirection choice) {
  if (choice == UpDirection::world_z || nodes.empty()) return Vector3::UnitZ();
  const Vector3 base = nodes.front().world_from_body.translation;
  Vector3 mean = Vector3::Zero();
  for (const StampedPose& node : nodes) mean += node.world_from_body.translation - base;
  mean /= static_cast<double>(nodes.size());

  Matrix3 covariance = Matrix3::Zero();
  Vector3 area = Vector3::Zero();
  Vector3 before = Vector3::Zero();
  for (const StampedPose& node : nodes) {
    const Vector3 point = node.world_from_body.translation - base - mean;
    covariance += point * point.transpose();
    area += before.cross(point);
    before = point;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(covariance);
  const Vector3 l = solver.eigenvalues().cwiseMax(0.0);
  const Matrix3& axes = solver.eigenvectors();
  Matrix3 least = axes.col(0) * axes.col(0).transpose();
  for (int i = 1; i < 3 && l(i) - l(0) <= kGap * std::sqrt(l(i) * l(2)); ++i) {
    least += axes.col(i) * axes.col(i).transpose();
  }
  const bool is_axis = least.trace() < 1.5;
  const Vector3 up =
      is_axis ? Vector3(axes.col(0)) : body_axis_in(least, nodes.front().world_from_body.rotation);
  return area.dot(up) < 0.0 ? Vector3(-up) : up;
}

}  // namespace loopbench::methods::manifold
