#include "methods/smoothers/manifold/fit_axes.hpp"

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

Pose axes_from_world_pose(const Problem& problem, const Rotation& axes_from_world) {
  if (problem.keyframes.empty()) return {axes_from_world, Vector3::Zero()};
  const Vector3& first = problem.keyframes.front().world_from_body.translation;
  return {axes_from_world, -(axes_from_world * first)};
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

Rotation level_axes(const Trajectory& poses) {
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

Rotation plane_axes(Plane plane) {
  Matrix3 axes = Matrix3::Identity();
  if (plane == Plane::yoz) axes << 0, 1, 0, 0, 0, 1, 1, 0, 0;   // x' = y, y' = z, z' = x
  if (plane == Plane::xoz) axes << 1, 0, 0, 0, 0, 1, 0, -1, 0;  // x' = x, y' = z, z' = -y
  return Rotation(axes);
}

Problem in_axes(const Problem& problem, const Rotation& axes_from_world) {
  Problem out = problem;
  const Pose to_axes = axes_from_world_pose(problem, axes_from_world);
  for (Trajectory* poses : {&out.keyframes, &out.frames}) {
    for (StampedPose& pose : *poses) pose.world_from_body = to_axes * pose.world_from_body;
  }
  return out;
}

std::unique_ptr<const Curve> in_world(std::unique_ptr<const Curve> curve,
                                      const Problem& problem,
                                      const Rotation& axes_from_world) {
  return std::make_unique<CurveInAxes>(std::move(curve),
                                       axes_from_world_pose(problem, axes_from_world).inverse());
}

}  // namespace loopbench::methods::manifold
