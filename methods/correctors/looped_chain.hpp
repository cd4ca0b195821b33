/// A chain of odometry with loops, solved in closed form through the loop multipliers.
#pragma once

#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/correctors/loop_equations.hpp"

namespace loopbench {

/// As the edges and closures of the problem say, without drift.
ChainBelief stated_belief(const Problem& problem);

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

  const std::vector<Twist>& errors() const { return at_.errors; }

  /// One step that lowers the cost or, to rounding, keeps it; false when none is found.
  /// Gauss-Newton at first, halved until it fits; Newton (loop_newton.hpp) once a step no longer
  /// halves the cost. A straight step leaves loops open that bend, and so stiffly that hardly any
  /// step would do: what is left of them is closed again before the cost is compared (a
  /// second-order correction). Throws std::runtime_error when the loop equations are not positive
  /// definite. Complexity O(edges + (6 closures)^3).
  bool step();

  LoopJacobian linearised() const;

  const LoopSums& sums() const { return sums_; }
  const std::vector<Twist>& drift() const { return at_.drift; }

  Trajectory keyframes() const;

 private:
  /// A place to step to.
  struct Candidate {
    Corrections at;
    std::vector<Pose> poses;
    Eigen::VectorXd loop_errors;  ///< eta, 6 a closure
    double cost = 0.0;
  };

  bool step_towards(const Corrections& wanted, const LoopEquations& equations, double shortest);
  Candidate candidate(Corrections at) const;
  void close_loops(Candidate& tried, const LoopEquations& equations) const;
  /// By the noise w_i of the edges, and by drift.
  Corrections gradient(const LoopJacobian& jacobian) const;
  std::vector<Pose> integrate(const std::vector<Twist>& errors) const;
  Eigen::VectorXd loop_errors(const std::vector<Pose>& poses) const;
  double cost_of(const Corrections& at, const Eigen::VectorXd& loop_errors) const;

  const Problem& problem_;
  LoopSums sums_;
  ChainBelief belief_;
  std::vector<Pose> poses_;
  Corrections at_;
  Vector3 centre_;
  double cost_ = 0.0;
  bool near_ = false;  ///< to a minimum: the last step did not halve the cost
};

}  // namespace loopbench
