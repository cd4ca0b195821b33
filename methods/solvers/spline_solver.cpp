#include "methods/solvers/spline_solver.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "datasets/core/knot_span.hpp"
#include "methods/smoothers/spline/curve.hpp"
#include "methods/solvers/groups/se3.hpp"

namespace loopbench::methods {
namespace {

std::size_t first_control(const SplineBasis& basis, double time) {
  return KnotSpan(basis.breaks()).find(time);
}

using Block = std::array<double, Se3::kSize>;

/// Perturbation [p + d; Exp(a) R]. Cost functions write their derivative with respect to [d; a]
/// into the first six columns of the ambient Jacobian, so this Jacobian is a projection.
class SplitPerturbation final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* d, double* out) const override {
    const Pose pose = Se3::read(x);
    const Vector3 rotation(d[3], d[4], d[5]);
    Se3::write({(exp_so3(rotation) * pose.rotation).normalized(),
                pose.translation + Vector3(d[0], d[1], d[2])},
               out);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* d) const override {
    const Pose to = Se3::read(y), from = Se3::read(x);
    Eigen::Map<Twist> out(d);
    out =
        twist(to.translation - from.translation, log_so3(to.rotation * from.rotation.conjugate()));
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
};

/// Residual root * e with Omega = root' root.
class SplineCost final : public ceres::CostFunction {
 public:
  SplineCost(SplineFactor factor, const Matrix6& root) : factor_(std::move(factor)), root_(root) {
    set_num_residuals(6);
    mutable_parameter_block_sizes()->assign(factor_.controls().size(), 7);
  }

  bool Evaluate(double const* const* x, double* residual, double** jacobians) const override {
    std::vector<Pose> controls(factor_.controls().size());
    for (std::size_t k = 0; k < controls.size(); ++k) controls[k] = Se3::read(x[k]);
    const SplineFactor::Residual evaluated = factor_.evaluate(controls);
    Eigen::Map<Twist> out(residual);
    out = root_ * evaluated.error;
    for (std::size_t k = 0; jacobians != nullptr && k < controls.size(); ++k) {
      if (jacobians[k] == nullptr) continue;
      Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>> J(jacobians[k]);
      J.leftCols<6>() = root_ * evaluated.by_control[k];
      J.col(6).setZero();
    }
    return true;
  }

 private:
  SplineFactor factor_;
  Matrix6 root_;
};

Matrix6 root_of(const Edge& edge) {
  const Eigen::LLT<Matrix6> factor(edge.information);
  if (factor.info() != Eigen::Success) {
    throw std::runtime_error("spline fit: the information matrix of edge " +
                             std::to_string(edge.from) + " - " + std::to_string(edge.to) +
                             " is not positive definite");
  }
  return factor.matrixU();
}

}  // namespace

/// Pose X(t) and the derivatives of X(t) Exp(d) with respect to the controls of its window.
struct SplineFactor::PoseDerivative {
  Pose pose;
  std::array<Matrix6, SplineBasis::kMaxOrder> by_control;
};

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

SplineSummary solve_spline(const SplineBasis& basis,
                           std::vector<Pose>& controls,
                           const SplineProblem& problem,
                           int max_iterations) {
  SplitPerturbation manifold;
  ceres::Problem::Options problem_options;
  problem_options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem least_squares(problem_options);
  std::vector<Block> blocks(controls.size());
  for (std::size_t j = 0; j < blocks.size(); ++j) {
    Se3::write(controls[j], blocks[j].data());
    least_squares.AddParameterBlock(blocks[j].data(), 7, &manifold);
  }
  const auto add = [&](SplineFactor factor, const Matrix6& root) {
    std::vector<double*> parameters;
    for (const std::size_t j : factor.controls()) parameters.push_back(blocks[j].data());
    least_squares.AddResidualBlock(new SplineCost(std::move(factor), root), nullptr, parameters);
  };
  for (const PoseAt& pose : problem.poses) add({basis, pose}, Matrix6::Identity());
  for (const EdgeBetween& edge : problem.edges) add({basis, edge}, root_of(edge.edge));
  if (problem.fix_start) least_squares.SetParameterBlockConstant(blocks.front().data());

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-16;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-14;
  // The initial values are close, so nearly undamped steps converge quadratically.
  options.initial_trust_region_radius = 1e8;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &least_squares, &summary);
  if (!summary.IsSolutionUsable()) throw std::runtime_error("spline fit: " + summary.message);
  for (std::size_t j = 0; j < blocks.size(); ++j) controls[j] = Se3::read(blocks[j].data());
  return {static_cast<int>(summary.iterations.size()),
          summary.initial_cost,
          summary.final_cost,
          summary.termination_type == ceres::CONVERGENCE};
}

}  // namespace loopbench::methods
