/// Robust least squares on a pose graph with Ceres.
#pragma once

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "methods/solvers/pose_graph_solver.hpp"
#include "methods/solvers/residuals.hpp"

namespace loopbench::methods {

/// X * Exp(d). Cost functions write their derivative with respect to d into the first columns of
/// the ambient Jacobian, so this Jacobian is a projection and no derivatives of quaternion entries
/// are needed.
template <class G>
class RightPerturbation final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return G::kSize; }
  int TangentSize() const override { return G::kDof; }
  bool Plus(const double* x, const double* d, double* out) const override {
    const Eigen::Map<const typename G::Tangent> twist(d);
    G::write(G::compose(G::read(x), G::exp(twist)), out);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, G::kSize, G::kDof, Eigen::RowMajor>> J(jacobian);
    J.setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* d) const override {
    Eigen::Map<typename G::Tangent> twist(d);
    twist = G::log(G::compose(G::inverse(G::read(x)), G::read(y)));
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, G::kDof, G::kSize, Eigen::RowMajor>> J(jacobian);
    J.setIdentity();
    return true;
  }
};

/// Residual root * e with Omega = root' root.
template <class G>
class EdgeCost final : public ceres::SizedCostFunction<G::kDof, G::kSize, G::kSize> {
 public:
  EdgeCost(const Edge& edge, double weight, double scale_sigma)
      : back_(G::inverse(G::from(measured(edge)))),
        root_(information_root<G>(edge, weight, scale_sigma)) {}

  bool Evaluate(double const* const* x, double* residual, double** jacobians) const override {
    Eigen::Map<typename G::Tangent> out(residual);
    const auto from = G::read(x[0]);
    const auto to = G::read(x[1]);
    if (jacobians == nullptr) {
      out = root_ * group_edge_error<G>(back_, G::compose(G::inverse(from), to));
      return true;
    }
    const EdgeResidual<G> at = edge_residual<G>(back_, from, to);
    out = root_ * at.error;
    fill(jacobians[0], at.by_from);
    fill(jacobians[1], at.by_to);
    return true;
  }

 private:
  void fill(double* block, const typename G::Square& J) const {
    if (block == nullptr) return;
    Eigen::Map<Eigen::Matrix<double, G::kDof, G::kSize, Eigen::RowMajor>> map(block);
    map.setZero();
    map.template leftCols<G::kDof>() = root_ * J;
  }

  typename G::Element back_;
  typename G::Square root_;
};

/// Residual root * e with C^-1 = root' root.
template <class G>
class AnchorCost final : public ceres::SizedCostFunction<3, G::kSize> {
 public:
  explicit AnchorCost(const Anchor& anchor)
      : anchor_(anchor), root_(anchor.covariance.inverse().llt().matrixU()) {}

  bool Evaluate(double const* const* x, double* residual, double** jacobians) const override {
    const AnchorResidual at = anchor_residual(anchor_, G::to_scaled_pose(G::read(x[0])).pose);
    Eigen::Map<Vector3> out(residual);
    out = root_ * at.error;
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    Eigen::Map<Eigen::Matrix<double, 3, G::kSize, Eigen::RowMajor>> map(jacobians[0]);
    map.setZero();
    for (int i = 0; i < G::kDof; ++i) map.col(i) = root_ * at.by_pose.col(twist_axis<G>(i));
    return true;
  }

 private:
  Anchor anchor_;
  Matrix3 root_;
};

/// A loss of a width; `rho(width, x, out)` computes it and its first two derivatives, where x is
/// the squared residual.
class LossOfWidth final : public ceres::LossFunction {
 public:
  using Rho = void (*)(double width, double x, double* out);
  LossOfWidth(double width, Rho rho) : width_(width), rho_(rho) {}
  void Evaluate(double x, double out[3]) const override { rho_(width_, x, out); }

 private:
  double width_;
  Rho rho_;
};

inline void dynamic_covariance_scaling(double width, double x, double* rho) {
  if (x <= width) {
    rho[0] = x, rho[1] = 1.0, rho[2] = 0.0;
    return;
  }
  const double sum = width + x;
  const double four = 4.0 * width * width;
  rho[0] = 3.0 * width - four / sum, rho[1] = four / (sum * sum);
  rho[2] = -2.0 * four / (sum * sum * sum);
}

inline void switchable_constraint(double width, double x, double* rho) {
  const double sum = width + x;
  const double s = width / sum;  // the switch
  rho[0] = s * x, rho[1] = s * s, rho[2] = -2.0 * s * s / sum;
}

inline std::unique_ptr<ceres::LossFunction> make_loss(const PoseGraphSettings& settings) {
  const double width = settings.loss_width;
  switch (settings.loss) {
    case RobustLoss::none:
      return nullptr;
    case RobustLoss::huber:
      return std::make_unique<ceres::HuberLoss>(std::sqrt(width));
    case RobustLoss::cauchy:
      return std::make_unique<ceres::CauchyLoss>(std::sqrt(width));
    case RobustLoss::dcs:
      return std::make_unique<LossOfWidth>(
          width, settings.is_smoothed ? switchable_constraint : dynamic_covariance_scaling);
  }
  return nullptr;
}

inline ceres::Solver::Options solver_options(const PoseGraphSettings& settings) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = settings.max_iterations;
  options.function_tolerance = settings.tolerance;
  // Only the change of the cost ends the iterations: gradients depend on units, and steps on the
  // length of the trajectory.
  options.gradient_tolerance = 1e-16;
  options.parameter_tolerance = 1e-16;
  // Long chains have directions with 1e-9 of the stiffness of their diagonal, along which Ceres's
  // default damping of 1e-4 converges very slowly. Unsuccessful steps shrink the region quickly.
  options.initial_trust_region_radius = 1e12;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  return options;
}

/// Whether the last steps were rejected although they exceed rounding: the cost is flat to its
/// rounding error, but the poses have not converged. On long chains 1e-12 of the cost corresponds
/// to a tenth of a millimetre.
inline bool stalled(const ceres::Solver::Summary& summary) {
  constexpr double kConverged = 1e-6;  // [m], [rad], norm over all poses
  if (summary.termination_type != ceres::CONVERGENCE) return false;
  double rejected = 0.0;
  for (auto last = summary.iterations.rbegin(); last != summary.iterations.rend(); ++last) {
    if (last->step_is_successful) break;
    rejected = last->step_norm;  // ends with the earliest of them, which is damped least
  }
  return rejected > kConverged;
}

/// Options for a few more steps that may raise the cost.
inline ceres::Solver::Options polishing_options(const PoseGraphSettings& settings) {
  constexpr int kMaxIterations = 50;
  ceres::Solver::Options options = solver_options(settings);
  options.max_num_iterations = std::min(kMaxIterations, settings.max_iterations);
  options.use_nonmonotonic_steps = true;
  return options;
}

/// Moves `x`, in the world of pose 0, to a minimum of the cost of solve_pose_graph().
template <class G>
PoseGraphSummary minimise_with_ceres(std::vector<typename G::Element>& x,
                                     const WeightedEdges& edges,
                                     const PoseGraphSettings& settings) {
  RightPerturbation<G> manifold;
  const auto loss = make_loss(settings);
  ceres::Problem::Options problem_options;
  problem_options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  problem_options.disable_all_safety_checks = true;
  ceres::Problem problem(problem_options);
  std::vector<std::array<double, static_cast<std::size_t>(G::kSize)>> blocks(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    G::write(x[i], blocks[i].data());
    problem.AddParameterBlock(blocks[i].data(), G::kSize, &manifold);
  }
  edges.for_each([&](const Edge& edge, double weight, bool is_closure) {
    problem.AddResidualBlock(new EdgeCost<G>(edge, weight, settings.scale_sigma),
                             is_closure ? loss.get() : nullptr,
                             blocks[edge.from].data(),
                             blocks[edge.to].data());
  });
  if constexpr (G::kDof <= 6) {
    for (const Anchor& anchor : settings.anchors) {
      problem.AddResidualBlock(new AnchorCost<G>(anchor), nullptr, blocks[anchor.keyframe].data());
    }
  }
  if (!settings.is_first_free) problem.SetParameterBlockConstant(blocks.front().data());

  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(settings), &problem, &summary);
  if (!summary.IsSolutionUsable()) throw std::runtime_error("pose graph: " + summary.message);
  int linear_solves = summary.num_linear_solves;
  double cost = summary.final_cost;
  if (stalled(summary)) {
    ceres::Solver::Summary polished;
    ceres::Solve(polishing_options(settings), &problem, &polished);
    if (!polished.IsSolutionUsable()) throw std::runtime_error("pose graph: " + polished.message);
    linear_solves += polished.num_linear_solves;
    cost = polished.final_cost;
  }
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = G::read(blocks[i].data());
  return {
      linear_solves, summary.initial_cost, cost, summary.termination_type == ceres::CONVERGENCE};
}

}  // namespace loopbench::methods
