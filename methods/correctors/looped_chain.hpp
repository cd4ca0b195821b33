/// A chain of odometry with loops, solved in closed form through the loop multipliers.
#pragma once

#include <Eigen/Core>
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

/// As the edges and closures of the problem say, without drift.
ChainBelief stated_belief(const Problem& problem);

/// How the closures' errors hang on the edges' at the current poses: eta = c + A e, where
/// A_ki = loop[k] edge[i] for every edge i inside loop k, 0 outside. O(edges + closures).
struct LoopJacobian {
  std::vector<Matrix6> edge;
  std::vector<Matrix6> loop;
  Eigen::VectorXd gap;  ///< c, 6 a closure
};

/// The chain at its current corrections: poses, errors e_i and drift beta. Positions are kept
/// relative to the chain's centroid: adjoints grow with the distance from the origin and would cost
/// digits far from it. Keeps references to the problem.
class LoopedChain {
 public:
  LoopedChain(const Problem& problem, ChainBelief belief);

  /// Half of sum w' S^-1 w + sum beta' V^-1 beta + sum eta' S_L^-1 eta. Not finite: no start.
  double cost() const { return cost_; }

  /// Exchanges the belief and keeps poses, errors and drift as they are.
  void believe(ChainBelief belief);

  /// Exchanges the errors e_i, one an odometry edge, and keeps the drift as it is.
  void correct_by(std::vector<Twist> errors);

  const std::vector<Twist>& errors() const { return errors_; }

  /// One Gauss-Newton step, halved until the cost falls or, to rounding, stays. False when no
  /// step does that. Throws
  /// std::runtime_error when the loop equations are not positive definite.
  /// Complexity O(edges + (6 closures)^3).
  bool step();

  LoopJacobian linearised() const;

  const LoopSums& sums() const { return sums_; }
  const std::vector<Twist>& drift() const { return drift_; }

  Trajectory keyframes() const;

 private:
  struct Corrections {
    std::vector<Twist> errors;
    std::vector<Twist> drift;
  };

  Corrections solve() const;
  std::vector<Pose> integrate(const std::vector<Twist>& errors) const;
  double cost_of(const Corrections& at, const std::vector<Pose>& poses) const;

  const Problem& problem_;
  LoopSums sums_;
  ChainBelief belief_;
  std::vector<Pose> poses_;
  std::vector<Twist> errors_;  ///< e_i of odometry edge i
  std::vector<Twist> drift_;   ///< beta_j
  Vector3 centre_;
  double cost_ = 0.0;
};

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
