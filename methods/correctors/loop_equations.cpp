#include "methods/correctors/loop_equations.hpp"

#include <stdexcept>

namespace loopbench::methods {

NoiseModel stated_noise_model(const Problem& problem) {
  NoiseModel out;
  for (const Edge& edge : problem.odometry) {
    out.information.push_back(edge.information);
    out.covariance.push_back(edge.information.inverse());
  }
  for (const Edge& loop : problem.closures) {
    out.closure_information.push_back(loop.information);
    out.closure_covariance.push_back(loop.information.inverse());
  }
  return out;
}

LoopEquations loop_equations(LoopJacobian jacobian,
                             const LoopSums& sums,
                             const NoiseModel& noise_model) {
  Eigen::MatrixXd matrix = propagate_covariance(
      jacobian, sums, running_sum(sums, [&](std::size_t i) -> Matrix6 {
        return jacobian.edge[i] * noise_model.covariance[i] * jacobian.edge[i].transpose();
      }));
  for (std::size_t k = 0; k < sums.loops(); ++k) {
    const auto row = static_cast<Eigen::Index>(6 * k);
    matrix.block<6, 6>(row, row) += noise_model.closure_covariance[k];
  }
  LoopEquations out;
  out.factor.compute(matrix);
  if (out.factor.info() != Eigen::Success) {
    throw std::runtime_error("the loop equations are not positive definite");
  }
  out.jacobian = std::move(jacobian);
  return out;
}

std::vector<Twist> minimum_cost_corrections(const LoopEquations& equations,
                                            const Eigen::VectorXd& gap,
                                            const std::vector<Edge>& closures,
                                            const NoiseModel& noise_model) {
  const Eigen::VectorXd lambda = equations.factor.solve(gap);
  const std::vector<Twist> pull = constraint_force_increments(
      equations.jacobian.loop, equations.jacobian.edge.size(), closures, lambda);
  std::vector<Twist> out(equations.jacobian.edge.size());
  Twist sum = Twist::Zero();
  for (std::size_t i = 0; i < out.size(); ++i) {
    sum += pull[i];
    out[i] = -noise_model.covariance[i] * (equations.jacobian.edge[i].transpose() * sum);
  }
  return out;
}

Eigen::VectorXd loop_residual_change(const LoopJacobian& jacobian,
                                     const LoopSums& sums,
                                     const std::vector<Twist>& errors) {
  const std::vector<Twist> running =
      running_sum(sums, [&](std::size_t i) -> Twist { return jacobian.edge[i] * errors[i]; });
  Eigen::VectorXd out(static_cast<Eigen::Index>(6 * sums.loops()));
  for (std::size_t k = 0; k < sums.loops(); ++k) {
    of_closure(out, k) = jacobian.loop[k] * sums.over(running, k);
  }
  return out;
}

std::vector<Twist> constraint_force_increments(const std::vector<Matrix6>& loop,
                                               std::size_t edges,
                                               const std::vector<Edge>& closures,
                                               const Eigen::VectorXd& lambda) {
  std::vector<Twist> out(edges + 1, Twist::Zero());
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const Twist pull = loop[k].transpose() * of_closure(lambda, k);
    out[closures[k].from] += pull;
    out[closures[k].to] -= pull;
  }
  return out;
}

Eigen::MatrixXd propagate_covariance(const LoopJacobian& jacobian,
                                     const LoopSums& sums,
                                     const std::vector<Matrix6>& running) {
  const auto size = static_cast<Eigen::Index>(6 * sums.loops());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t k = 0; k < sums.loops(); ++k) {
    for (std::size_t l = 0; l <= k; ++l) {
      if (!sums.overlap(k, l)) continue;
      out.block<6, 6>(static_cast<Eigen::Index>(6 * k), static_cast<Eigen::Index>(6 * l)) =
          jacobian.loop[k] * sums.over_both(running, k, l) * jacobian.loop[l].transpose();
    }
  }
  return out;
}

}  // namespace loopbench::methods
