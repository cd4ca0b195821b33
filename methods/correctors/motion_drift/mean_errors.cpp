#include "methods/correctors/motion_drift/mean_errors.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <numeric>
#include <stdexcept>

namespace loopbench {
namespace {

/// One a term: mean_s(v_js C_s^-1 c), six numbers a closure.
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

/// edge[i]' times what all loops over edge i pull at it.
std::vector<Twist> pulls(const Eigen::VectorXd& multipliers,
                         const LoopJacobian& jacobian,
                         const std::vector<Edge>& closures) {
  std::vector<Twist> change(jacobian.edge.size() + 1, Twist::Zero());
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const Twist pull =
        jacobian.loop[k].transpose() * multipliers.segment<6>(static_cast<Eigen::Index>(6 * k));
    change[closures[k].from] += pull;
    change[closures[k].to] -= pull;
  }
  std::vector<Twist> out(jacobian.edge.size());
  Twist sum = Twist::Zero();
  for (std::size_t i = 0; i < out.size(); ++i) {
    sum += change[i];
    out[i] = jacobian.edge[i].transpose() * sum;
  }
  return out;
}

/// Keeps the axes a term is about.
Twist on_axes_of(const Term& term, const Twist& all) {
  Twist out = Twist::Zero();
  const Eigen::Index at = term.half == Half::translation ? 0 : 3;
  if (term.axis < 0) {
    out.segment<3>(at) = all.segment<3>(at);
  } else {
    out[at + term.axis] = all[at + term.axis];
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
  const LoopJacobian jacobian = chain.linearised();
  const std::vector<Eigen::VectorXd> multipliers =
      mean_multipliers(models, evidence, jacobian.gap.size());

  std::vector<Twist> out(motions.size(), Twist::Zero());
  for (std::size_t j = 0; j < terms.size(); ++j) {
    const Term& term = terms[j];
    if (term.cause == Cause::closures) continue;
    const std::vector<Twist> pull = pulls(multipliers[j], jacobian, problem.closures);
    Twist together = Twist::Zero();  // drift: one rate all along
    for (std::size_t i = 0; i < pull.size(); ++i) {
      together += drifted(term.growth, motions[i]) * pull[i];
    }
    for (std::size_t i = 0; i < pull.size(); ++i) {
      if (term.cause == Cause::stated) {
        out[i] -= problem.odometry[i].information.inverse() * pull[i];
      } else if (term.cause == Cause::drift) {
        out[i] -= drifted(term.growth, motions[i]) * on_axes_of(term, together);
      } else {
        out[i] -= grown(term.growth, motions[i]) * on_axes_of(term, pull[i]);
      }
    }
  }
  return out;
}

}  // namespace loopbench
