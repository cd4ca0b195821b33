#include "methods/smoothers/manifold/fit_axes.hpp"

#include <Eigen/Eigenvalues>

namespace loopbench::methods::manifold {
namespace {

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
  const Eigen::SelfAdjointEigenSolver<Matrix3> spread(covariance);
  Vector3 x = spread.eigenvectors().col(2);
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
