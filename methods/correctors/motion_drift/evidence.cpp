#include "methods/correctors/motion_drift/evidence.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace loopbench::methods {
namespace {

Matrix6 block_of(Component component, const Matrix6& matrix) {
  Matrix6 out = Matrix6::Zero();
  const Eigen::Index at = component == Component::translation ? 0 : 3;
  out.block<3, 3>(at, at) = matrix.block<3, 3>(at, at);
  return out;
}

Eigen::MatrixXd share_of(const Term& term,
                         const LoopJacobian& jacobian,
                         const LoopSums& sums,
                         const Problem& problem,
                         const std::vector<EdgeMotion>& motions) {
  const Eigen::Index component = term.component == Component::translation ? 0 : 3;
  switch (term.kind) {
    case TermKind::noise:
      return propagate_covariance(jacobian, sums, running_sum(sums, [&](std::size_t i) -> Matrix6 {
                                    const auto columns = jacobian.edge[i].middleCols<3>(component);
                                    return regressor_value(term.regressor, motions[i]) * columns *
                                           columns.transpose();
                                  }));
    case TermKind::stated:
      return propagate_covariance(jacobian, sums, running_sum(sums, [&](std::size_t i) -> Matrix6 {
                                    return jacobian.edge[i] *
                                           problem.odometry[i].information.inverse() *
                                           jacobian.edge[i].transpose();
                                  }));
    case TermKind::drift: {
      const Eigen::MatrixXd shape = propagate_drift(
          jacobian, sums, running_sum(sums, [&](std::size_t i) -> Matrix6 {
            return drift_regressor_value(term.regressor, motions[i]) * jacobian.edge[i];
          }));
      const Eigen::MatrixXd columns =
          shape.middleCols(component + (term.axis < 0 ? 0 : term.axis), term.axis < 0 ? 3 : 1);
      return columns * columns.transpose();
    }
    case TermKind::closures:
      break;
  }
  const auto size = static_cast<Eigen::Index>(6 * sums.loops());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t k = 0; k < sums.loops(); ++k) {
    const auto at = static_cast<Eigen::Index>(6 * k);
    out.block<6, 6>(at, at) = block_of(term.component, problem.closures[k].information.inverse());
  }
  return out;
}

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
  std::vector<Twist> out =
      constraint_force_increments(jacobian.loop, jacobian.edge.size(), closures, multipliers);
  out.pop_back();
  Twist sum = Twist::Zero();
  for (std::size_t i = 0; i < out.size(); ++i) {
    sum += out[i];
    out[i] = jacobian.edge[i].transpose() * sum;
  }
  return out;
}

}  // namespace

Evidence evidence_of(const MotionModel& model,
                     const LoopedChain& chain,
                     const Problem& problem,
                     const std::vector<EdgeMotion>& motions,
                     const std::vector<std::size_t>& closures) {
  const LoopJacobian jacobian = chain.linearise();
  Evidence out;
  out.rows = gap_rows(closures, problem.planar);
  out.gap = jacobian.gap(out.rows);
  for (const Term& term : model) {
    const Eigen::MatrixXd share = share_of(term, jacobian, chain.sums(), problem, motions);
    out.shares.push_back(share(out.rows, out.rows));
  }
  return out;
}

Eigen::MatrixXd gap_covariance(const MotionModel& model, const Evidence& evidence) {
  const Eigen::Index size = evidence.gap.size();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t j = 0; j < model.size(); ++j) {
    if (model[j].value == 0.0) continue;
    out.noalias() += model[j].value * evidence.shares[j];  // faster than the lower triangle alone
  }
  return out;
}

double log_evidence(const MotionModel& model, const Evidence& evidence) {
  Eigen::MatrixXd covariance = gap_covariance(model, evidence);
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower> factor(covariance);  // in place
  if (factor.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
  const Eigen::VectorXd whitened = factor.matrixL().solve(evidence.gap);
  const double log_determinant = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
  return -0.5 * (whitened.squaredNorm() + log_determinant +
                 static_cast<double>(evidence.gap.size()) * std::log(2.0 * std::numbers::pi));
}

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
