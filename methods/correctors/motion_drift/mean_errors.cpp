#include "methods/correctors/motion_drift/mean_errors.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <numeric>
#include <stdexcept>

namespace loopbench::methods {
namespace {

/// For each term j: mean_s(v_js C_s^-1 c), six numbers per closure.
std::vector<Eigen::VectorXd> mean_multipliers(const std::vector<MotionModel>& models,
                                              const Evidence& evidence,
                                              Eigen::Index size) {
  const std::size_t terms = models.front().size();
  std::vector<Eigen::VectorXd> out(terms, Eigen::VectorXd::Zero(size));
  for (const MotionModel& model : models) {
    const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factor(gap_covariance(model, evidence));
    if (factor.info() != Eigen::Success) {
      throw std::runtime_error("the loop equations are not positive definite");
    }
    const Eigen::VectorXd multipliers =
        factor.solve(evidence.gap) / static_cast<double>(models.size());
    for (std::size_t j = 0; j < terms; ++j) {
      out[j](evidence.rows) += model[j].value * multipliers;
    }
  }
  return out;
}

/// For each edge i: edge[i]' times the summed generalised force of all loops that enclose it.
std::vector<Twist> edge_forces(const Eigen::VectorXd& multipliers,
                               const LoopJacobian& jacobian,
                               const std::vector<Edge>& closures) {
  std::vector<Twist> out = constraint_force_increments(jacobian, closures, multipliers);
  out.pop_back();
  Twist sum = Twist::Zero();
  for (std::size_t i = 0; i < out.size(); ++i) {
    sum += out[i];
    out[i] = jacobian.edge[i].transpose() * sum;
  }
  return out;
}

}  // namespace

std::vector<Twist> mean_errors(const std::vector<MotionModel>& models,
                               const LoopedChain& chain,
                               const Problem& problem,
                               const std::vector<EdgeMotion>& motions) {
  const MotionModel& terms = models.front();
  std::vector<std::size_t> all(problem.closures.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const Evidence evidence = evidence_of(terms, chain, problem, motions, all);
  const LoopJacobian jacobian = chain.linearise();
  const std::vector<Eigen::VectorXd> multipliers =
      mean_multipliers(models, evidence, jacobian.gap.size());

  std::vector<Twist> out(motions.size(), Twist::Zero());
  for (std::size_t j = 0; j < terms.size(); ++j) {
    const Term& term = terms[j];
    if (term.kind == TermKind::closures) continue;
    const std::vector<Twist> force = edge_forces(multipliers[j], jacobian, problem.closures);
    Twist total = Twist::Zero();  // drift: one rate along the whole chain
    for (std::size_t i = 0; i < force.size(); ++i) {
      total += drift_regressor_value(term.regressor, motions[i]) * force[i];
    }
    for (std::size_t i = 0; i < force.size(); ++i) {
      if (term.kind == TermKind::stated) {
        out[i] -= problem.odometry[i].information.inverse() * force[i];
      } else if (term.kind == TermKind::drift) {
        out[i] -= drift_regressor_value(term.regressor, motions[i]) * on_axes(term, total);
      } else {
        out[i] -= regressor_value(term.regressor, motions[i]) * on_axes(term, force[i]);
      }
    }
  }
  return out;
}

}  // namespace loopbench::methods
