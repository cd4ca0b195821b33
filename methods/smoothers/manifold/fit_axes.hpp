/// Axes in which the article's equations y = f(x) and z = q(x, y) are fitted. The article does not
/// state them, and every such curve depends on them.
#pragma once

#include <Eigen/Eigenvalues>
#include <array>
#include <memory>

#include "datasets/core/curve.hpp"
#include "datasets/core/problem.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench::methods::manifold {

enum class UpDirection { pca, world_z };
inline auto choices(UpDirection) {
  return std::array{std::pair{"pca", UpDirection::pca}, std::pair{"world_z", UpDirection::world_z}};
}

/// estimate: axes of the estimate's world frame (for ORB-SLAM2 those of the first camera).
/// gravity: z up, x along the largest horizontal variance, see level_axes().
enum class FitAxes { estimate, gravity };
inline auto choices(FitAxes) {
  return std::array{std::pair{"estimate", FitAxes::estimate},
                    std::pair{"gravity", FitAxes::gravity}};
}

/// Plane of the planar curve: y = f(x), z = f(y) or z = f(x) (article, below equation 9).
enum class Plane { xoy, yoz, xoz };
inline auto choices(Plane) {
  return std::array{
      std::pair{"xoy", Plane::xoy}, std::pair{"yoz", Plane::yoz}, std::pair{"xoz", Plane::xoz}};
}

// Relative eigenvalue gap below which rounding of the input rotates the axis noticeably: the axis
// error is about eps * l2 / (l1 - l0) and moves points at a distance of sqrt(l1) from the axis.
inline constexpr double kGap = 1e-5;  // fraction of sqrt(l1 l2)

// Returns the first body axis that is not nearly perpendicular to the subspace. At least one of
// three has a component of more than sqrt(1/3) in it.
inline Vector3 body_axis_in(const Matrix3& projector, const Rotation& world_from_body) {
  Vector3 inside;
  for (const int axis : {2, 1, 0}) {
    inside = projector * (world_from_body * Vector3::Unit(axis));
    if (inside.norm() > 0.5) break;
  }
  return inside.normalized();
}

/// A curve of an axes frame, seen from the world frame.
class CurveInAxes final : public Curve {
 public:
  CurveInAxes(std::unique_ptr<const Curve> curve, const Pose& world_from_axes)
      : curve_(std::move(curve)), world_from_axes_(world_from_axes) {}

  double start() const override { return curve_->start(); }
  double end() const override { return curve_->end(); }

  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override {
    curve_->sample(times, poses);
    for (Pose& pose : poses) pose = world_from_axes_ * pose;
  }

 private:
  std::unique_ptr<const Curve> curve_;
  Pose world_from_axes_;
};

inline Pose axes_from_world_pose(const Problem& problem, const Rotation& axes_from_world) {
  if (problem.keyframes.empty()) return {axes_from_world, Vector3::Zero()};
  const Vector3& first = problem.keyframes.front().world_from_body.translation;
  return {axes_from_world, -(axes_from_world * first)};
}

/// Unit vector in the world. `pca` is the axis of least variance of the positions, so the result
/// rotates with the data. If this axis is not unique (straight line, at rest, equal variances) a
/// body axis of the first pose is used, which rotates with the data as well. The sign follows the
/// direction of travel; the fits do not depend on it, because mirrored z' and y' give mirrored
/// curves. O(n).
inline Vector3 up_axis(const Trajectory& nodes, UpDirection choice) {
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

/// Rotation axes_from_world to axes with z up, estimated without an IMU. z is the direction most
/// nearly perpendicular to the cameras' x axes, because a camera that is carried around rarely
/// rolls; upwards is where their y axes do not point. x is the horizontal direction of largest
/// variance of the positions, towards the pose farthest from the first. Requires a camera's axes (x
/// right, y down) as body frame and rotation about more than one axis; the error on the ORB-SLAM2
/// runs of the article's sequences is 1 to 5 degrees (tests/external/paper_test.py). The
/// result rotates with the data. O(n).
inline Rotation level_axes(const Trajectory& poses) {
  if (poses.empty()) return Rotation::Identity();
  Matrix3 rightward = Matrix3::Zero();
  Vector3 down = Vector3::Zero();
  Vector3 mean = Vector3::Zero();
  const Vector3 base = poses.front().world_from_body.translation;
  for (const StampedPose& pose : poses) {
    const Vector3 right = pose.world_from_body.rotation * Vector3::UnitX();
    rightward += right * right.transpose();
    down += pose.world_from_body.rotation * Vector3::UnitY();
    mean += (pose.world_from_body.translation - base) / static_cast<double>(poses.size());
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3> level(rightward);
  Vector3 up = level.eigenvectors().col(0);
  if (up.dot(down) > 0.0) up = -up;

  Matrix3 covariance = Matrix3::Zero();
  Vector3 farthest = Vector3::Zero();
  for (const StampedPose& pose : poses) {
    const Vector3 from_base = pose.world_from_body.translation - base;
    const Vector3 horizontal = from_base - mean - up.dot(from_base - mean) * up;
    covariance += horizontal * horizontal.transpose();
    if (from_base.norm() > farthest.norm()) farthest = from_base;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3> horizontal_axes(covariance);
  Vector3 x = horizontal_axes.eigenvectors().col(2);
  x -= up.dot(x) * up;
  x = x.norm() > 0.5 ? x.normalized() : up.unitOrthogonal();  // without horizontal motion
  if (x.dot(farthest) < 0.0) x = -x;
  Matrix3 axes;
  axes << x.transpose(), up.cross(x).transpose(), up.transpose();
  return Rotation(axes).normalized();
}

/// Rotation from (x, y, z) to axes whose first two span the plane.
inline Rotation plane_axes(Plane plane) {
  Matrix3 axes = Matrix3::Identity();
  if (plane == Plane::yoz) axes << 0, 1, 0, 0, 0, 1, 1, 0, 0;   // x' = y, y' = z, z' = x
  if (plane == Plane::xoz) axes << 1, 0, 0, 0, 0, 1, 0, -1, 0;  // x' = x, y' = z, z' = -y
  return Rotation(axes);
}

/// The problem in rotated axes, with its first keyframe at the origin. Edges are relative and
/// unchanged. O(keyframes + frames).
inline Problem in_axes(const Problem& problem, const Rotation& axes_from_world) {
  Problem out = problem;
  const Pose to_axes = axes_from_world_pose(problem, axes_from_world);
  for (Trajectory* poses : {&out.keyframes, &out.frames}) {
    for (StampedPose& pose : *poses) pose.world_from_body = to_axes * pose.world_from_body;
  }
  return out;
}

/// `curve` of in_axes(problem, axes_from_world) in the world frame of `problem`.
inline std::unique_ptr<const Curve> in_world(std::unique_ptr<const Curve> curve,
                                             const Problem& problem,
                                             const Rotation& axes_from_world) {
  return std::make_unique<CurveInAxes>(std::move(curve),
                                       axes_from_world_pose(problem, axes_from_world).inverse());
}

}  // namespace loopbench::methods::manifold
