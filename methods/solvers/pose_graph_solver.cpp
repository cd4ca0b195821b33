#include "methods/solvers/pose_graph_solver.hpp"

#include <ceres/ceres.h>

#include <cmath>
#include <stdexcept>

namespace loopbench {
namespace {

static_assert(sizeof(Pose) == 7 * sizeof(double), "a pose is Ceres's parameter block");

Pose read(const double* block) {
  return {Rotation(block[3], block[0], block[1], block[2]), {block[4], block[5], block[6]}};
}

void write(const Pose& pose, double* block) {
  Eigen::Map<Eigen::Vector4d> rotation(block);
  Eigen::Map<Vector3> translation(block + 4);
  rotation = pose.rotation.coeffs();
  translation = pose.translation;
}

/// X * Exp(d). Cost functions put their derivative by d into the first six columns of the ambient
/// Jacobian, so that this one is a plain projection: no chain through quaternion entries.
class RightPerturbation final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* d, double* out) const override {
    write(normalized(read(x) * exp_se3(Eigen::Map<const Twist>(d))), out);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>> J(jacobian);
    J.setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* d) const override {
    Eigen::Map<Twist> twist(d);
    twist = log_se3(read(x).inverse() * read(y));
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>> J(jacobian);
    J.setIdentity();
    return true;
  }
};

/// root * Log(Z^-1 X_i^-1 X_j) with Omega = root' root.
class EdgeCost final : public ceres::SizedCostFunction<6, 7, 7> {
 public:
  EdgeCost(const Edge& edge, double weight) : to_from_from_(edge.from_from_to.inverse()) {
    const Eigen::LLT<Matrix6> factor(weight * edge.information);
    if (factor.info() != Eigen::Success) {
      throw std::runtime_error("pose graph: information of edge " + std::to_string(edge.from) +
                               " - " + std::to_string(edge.to) + " is not positive definite");
    }
    root_ = factor.matrixU();
  }

  bool Evaluate(double const* const* x, double* residual, double** jacobians) const override {
    const Pose i_from_j = read(x[0]).inverse() * read(x[1]);
    const Twist error = log_se3(to_from_from_ * i_from_j);
    Eigen::Map<Twist> out(residual);
    out = root_ * error;
    if (jacobians == nullptr) return true;
    const Matrix6 by_j = root_ * inverse_right_jacobian_se3(error);
    const auto fill = [](double* block, const Matrix6& J) {
      if (block == nullptr) return;
      Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>> map(block);
      map.leftCols<6>() = J;
      map.col(6).setZero();
    };
    // X_i Exp(d): Exp(-d) X_i^-1 X_j = X_i^-1 X_j Exp(-Ad(X_j^-1 X_i) d).
    fill(jacobians[0], -by_j * adjoint(i_from_j.inverse()));
    fill(jacobians[1], by_j);
    return true;
  }

 private:
  Pose to_from_from_;
  Matrix6 root_;
};

/// rho and its two derivatives; x is the squared residual.
class DynamicCovarianceScaling final : public ceres::LossFunction {
 public:
  explicit DynamicCovarianceScaling(double width) : width_(width) {}
  void Evaluate(double x, double rho[3]) const override {
    if (x <= width_) {
      rho[0] = x, rho[1] = 1.0, rho[2] = 0.0;
      return;
    }
    const double sum = width_ + x;
    const double four = 4.0 * width_ * width_;
    rho[0] = 3.0 * width_ - four / sum, rho[1] = four / (sum * sum);
    rho[2] = -2.0 * four / (sum * sum * sum);
  }

 private:
  double width_;
};

class SolvedSwitch final : public ceres::LossFunction {
 public:
  explicit SolvedSwitch(double width) : width_(width) {}
  void Evaluate(double x, double rho[3]) const override {
    const double sum = width_ + x;
    const double s = width_ / sum;  // the switch
    rho[0] = s * x, rho[1] = s * s, rho[2] = -2.0 * s * s / sum;
  }

 private:
  double width_;
};

std::unique_ptr<ceres::LossFunction> make_loss(const PoseGraphSettings& settings) {
  const double width = settings.loss_width;
  switch (settings.loss) {
    case Loss::none:
      return nullptr;
    case Loss::huber:
      return std::make_unique<ceres::HuberLoss>(std::sqrt(width));
    case Loss::cauchy:
      return std::make_unique<ceres::CauchyLoss>(std::sqrt(width));
    case Loss::dcs:
      return std::make_unique<DynamicCovarianceScaling>(width);
    case Loss::switchable:
      return std::make_unique<SolvedSwitch>(width);
  }
  return nullptr;
}

}  // namespace

PoseGraphSummary solve_pose_graph(std::vector<Pose>& poses,
                                  const std::vector<Edge>& odometry,
                                  const std::vector<Edge>& closures,
                                  const std::vector<double>& weights,
                                  const PoseGraphSettings& settings) {
  RightPerturbation manifold;
  const auto loss = make_loss(settings);
  ceres::Problem::Options ours;
  ours.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ours.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ours);
  std::vector<std::array<double, 7>> blocks(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    write(poses[i], blocks[i].data());
    problem.AddParameterBlock(blocks[i].data(), 7, &manifold);
  }
  const auto add = [&](const Edge& edge, double weight, ceres::LossFunction* rho) {
    problem.AddResidualBlock(
        new EdgeCost(edge, weight), rho, blocks[edge.from].data(), blocks[edge.to].data());
  };
  for (const Edge& edge : odometry) add(edge, 1.0, nullptr);
  for (std::size_t k = 0; k < closures.size(); ++k) {
    if (weights[k] > 0.0) add(closures[k], weights[k], loss.get());
  }
  if (!blocks.empty()) problem.SetParameterBlockConstant(blocks.front().data());

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = settings.max_iterations;
  options.function_tolerance = settings.tolerance;
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) throw std::runtime_error("pose graph: " + summary.message);
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i] = read(blocks[i].data());
  return {static_cast<int>(summary.iterations.size()), summary.initial_cost, summary.final_cost};
}

}  // namespace loopbench
