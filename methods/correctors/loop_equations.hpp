/// The equations of a chain's loops: what their errors have to do with those of the odometry.
#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/correctors/loop_sums.hpp"

namespace loopbench {

/// What is believed of a chain before its loops are looked at. The error e_i of odometry edge i,
/// in X_i = X_{i-1} Z_i Exp(e_i), is e_i = sum_j diag(f_ji) beta_j + w_i with w_i ~ N(0, S_i) and
/// beta_j ~ N(0, diag(variances)): the same beta all along the chain.
struct ChainBelief {
  struct Drift {
    std::vector<Twist> shape;  ///< f_ji, one an edge
    Twist variance;            ///< of beta_j; 0 switches an axis off
  };

  std::vector<Matrix6> covariance;           ///< S_i
  std::vector<Matrix6> information;          ///< S_i^-1
  std::vector<Matrix6> closure_covariance;   ///< of a closure's twist
  std::vector<Matrix6> closure_information;  ///< its inverse
  std::vector<Drift> drift;                  ///< none: independent errors only
};

/// How the closures' errors hang on the edges' at the current poses: eta = c + A e, where
/// A_ki = loop[k] edge[i] for every edge i inside loop k, 0 outside. O(edges + closures).
struct LoopJacobian {
  std::vector<Matrix6> edge;
  std::vector<Matrix6> loop;
  Eigen::VectorXd gap;  ///< c, 6 a closure
};

/// Errors e_i of the odometry and drift beta_j.
struct Corrections {
  std::vector<Twist> errors;
  std::vector<Twist> drift;
};

/// A S A' + S_L, and what drift adds to it, factorised.
struct LoopEquations {
  LoopJacobian jacobian;
  std::vector<Eigen::MatrixXd> shapes;  ///< A f_j of each drift, 6 closures x 6
  Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factor;
};

/// Throws std::runtime_error when they are not positive definite. O(edges + (6 closures)^3).
LoopEquations loop_equations(LoopJacobian jacobian,
                             const LoopSums& sums,
                             const ChainBelief& belief);

/// The corrections of least cost, where loop errors are `gap` + A e. O(edges + closures^2).
Corrections least_cost(const LoopEquations& equations,
                       const Eigen::VectorXd& gap,
                       const std::vector<Edge>& closures,
                       const ChainBelief& belief);

/// A e. O(edges + closures).
Eigen::VectorXd along_loops(const LoopJacobian& jacobian,
                            const LoopSums& sums,
                            const std::vector<Twist>& errors);

/// What loops pull at edges with: edge[i]' times the sum of out[0] to out[i] is A' lambda at edge
/// i. One more than there are edges. O(edges + closures).
std::vector<Twist> loop_pull(const LoopJacobian& jacobian,
                             const std::vector<Edge>& closures,
                             const Eigen::VectorXd& lambda);

/// A S A' where `running` holds, before each cut, the sum of edge[i] S_i edge[i]'; its lower
/// triangle is filled. O(closures^2).
Eigen::MatrixXd through_loops(const LoopJacobian& jacobian,
                              const LoopSums& sums,
                              const std::vector<Matrix6>& running);

/// A f where `running` holds, before each cut, the sum of edge[i] diag(f_i): 6 closures x 6.
Eigen::MatrixXd through_loops_once(const LoopJacobian& jacobian,
                                   const LoopSums& sums,
                                   const std::vector<Matrix6>& running);

/// The sum of of(i) over the edges before each cut. O(edges).
template <class Of>
std::vector<Matrix6> running_sum(const LoopSums& sums, Of of) {
  std::vector<Matrix6> out;
  out.reserve(sums.cuts().size());
  Matrix6 total = Matrix6::Zero();
  std::size_t i = 0;
  for (const std::size_t cut : sums.cuts()) {
    for (; i < cut; ++i) total += of(i);
    out.push_back(total);
  }
  return out;
}

}  // namespace loopbench
