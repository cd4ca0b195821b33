#include "methods/solvers/spline_factor.hpp"

#include <algorithm>

#include "datasets/core/knot_span.hpp"
#include "methods/smoothers/spline/rotation_derivative.hpp"

namespace loopbench::methods {

/// Pose X(t) and the derivatives of X(t) Exp(d) with respect to the controls of its window.
struct SplineFactor::PoseDerivative {
  Pose pose;
  std::array<Matrix6, SplineBasis::kMaxOrder> by_control;
};

namespace {

std::size_t first_control(const SplineBasis& basis, double time) {
  return KnotSpan(basis.breaks()).find(time);
}

}  // namespace

SplineFactor::SplineFactor(const SplineBasis& basis, const PoseAt& measured)
    : order_(basis.order()), measured_(measured.pose) {
  const std::size_t first = first_control(basis, measured.time);
  collect_controls({first});
  from_ = {0, basis.values(first, measured.time), basis.cumulative(first, measured.time)};
}

SplineFactor::SplineFactor(const SplineBasis& basis, const EdgeBetween& measured)
    : order_(basis.order()), measured_(measured.edge.from_from_to) {
  const std::size_t from = first_control(basis, measured.from);
  const std::size_t to = first_control(basis, measured.to);
  collect_controls({from, to});
  const auto at = [&](std::size_t first) {
    return static_cast<std::size_t>(std::ranges::find(controls_, first) - controls_.begin());
  };
  from_ = {at(from), basis.values(from, measured.from), basis.cumulative(from, measured.from)};
  to_ = {at(to), basis.values(to, measured.to), basis.cumulative(to, measured.to)};
}

void SplineFactor::collect_controls(const std::vector<std::size_t>& firsts) {
  for (const std::size_t first : firsts) {
    for (std::size_t j = 0; j < order_; ++j) controls_.push_back(first + j);
  }
  std::ranges::sort(controls_);
  controls_.erase(std::unique(controls_.begin(), controls_.end()), controls_.end());
}

SplineFactor::PoseDerivative SplineFactor::pose_at(const Time& time,
                                                   const std::vector<Pose>& controls) const {
  PoseDerivative out;
  std::array<Rotation, SplineBasis::kMaxOrder> rotations;
  for (std::size_t j = 0; j < order_; ++j) {
    const Pose& control = controls[time.at + j];
    rotations[j] = control.rotation;
    out.pose.translation += time.values[j] * control.translation;
  }
  const RotationDerivative rotated = rotation_derivative(rotations.data(), order_, time.cumulative);
  out.pose.rotation = rotated.rotation.normalized();
  const Matrix3 body_from_world = out.pose.rotation.conjugate().toRotationMatrix();
  for (std::size_t j = 0; j < order_; ++j) {
    out.by_control[j].setZero();
    out.by_control[j].topLeftCorner<3, 3>() = time.values[j] * body_from_world;
    out.by_control[j].bottomRightCorner<3, 3>() = body_from_world * rotated.by[j];
  }
  return out;
}

SplineFactor::Residual SplineFactor::evaluate(const std::vector<Pose>& controls) const {
  Residual out;
  out.by_control.assign(controls_.size(), Matrix6::Zero());
  const auto add = [&](const Time& time, const PoseDerivative& at, const Matrix6& by_pose) {
    for (std::size_t j = 0; j < order_; ++j) {
      out.by_control[time.at + j] += by_pose * at.by_control[j];
    }
  };
  const PoseDerivative from = pose_at(from_, controls);
  if (!to_) {
    const Vector3 angle_error = log_so3(measured_.rotation.conjugate() * from.pose.rotation);
    out.error = twist(from.pose.translation - measured_.translation, angle_error);
    Matrix6 by_pose = Matrix6::Zero();
    by_pose.topLeftCorner<3, 3>() = from.pose.rotation.toRotationMatrix();
    by_pose.bottomRightCorner<3, 3>() = inverse_right_jacobian_so3(angle_error);
    add(from_, from, by_pose);
    return out;
  }
  const PoseDerivative to = pose_at(*to_, controls);
  const Pose from_from_to = from.pose.inverse() * to.pose;
  out.error = log_se3(measured_.inverse() * from_from_to);
  const Matrix6 by_to = inverse_right_jacobian_se3(out.error);
  // X_i Exp(d): Exp(-d) X_i^-1 X_j = X_i^-1 X_j Exp(-Ad(X_j^-1 X_i) d).
  add(from_, from, -by_to * adjoint(from_from_to.inverse()));
  add(*to_, to, by_to);
  return out;
}

}  // namespace loopbench::methods
