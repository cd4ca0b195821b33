#include "methods/solvers/spline_solver.hpp"

#include <ceres/ceres.h>

#include <array>
#include <stdexcept>

#include "methods/solvers/groups/se3.hpp"

namespace loopbench::methods {
namespace {

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

SplineSummary solve_spline(const SplineBasis& basis,
                           std::vector<Pose>& controls,
                           const SplineProblem& problem,
                           const SplineSettings& settings) {
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
  options.max_num_iterations = settings.max_iterations;
  options.function_tolerance = settings.tolerance;
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
