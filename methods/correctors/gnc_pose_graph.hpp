/// Graduated non-convexity on a pose graph: where it starts, and which of two minima it returns.
#pragma once

#include <functional>

#include "methods/correctors/gnc.hpp"
#include "methods/method.hpp"
#include "methods/solvers/pose_graph_solver.hpp"

namespace loopbench {

struct GncProblem {
  const Problem& problem;
  PoseGraphSettings settings;
  Gnc kind = Gnc::tls;
  double inlier_chi2 = 0.0;  ///< largest squared error of a true closure [-]
  bool consistent = true;    ///< start from the largest set of closures that agree
  /// Initial values of a problem. A relaxation takes every closure of it for true.
  std::function<std::vector<ScaledPose>(const Problem&)> initial;
};

struct GncSolution {
  std::vector<ScaledPose> poses;  ///< to solve from, with the weights
  std::vector<double> weights;    ///< one per closure
  int rounds = 0;
  int iterations = 0;  ///< linear solves
  double cost_before = 0.0;
};

/// Starts from the closures that agree with one another (consistency.hpp), with initial values of
/// them alone: a relaxation over false closures leads away. Starts from all closures
/// where no such set is known: the odometry is no whole chain, edges change the scale, or the
/// closures are too many to compare; and if that rejects any, from the odometry's spanning tree as
/// well. All closures are also tried when the first start keeps fewer than half of them. The
/// solution of least cost is returned, where a closure costs as `kind` says at its end: at most
/// `inlier_chi2`.
///
/// Adds the phases "check" and "graduate", and a note when fewer than half of the closures are
/// kept. Throws what solve_pose_graph() throws. O(starts rounds) sparse solves.
GncSolution solve_gnc(const GncProblem& of, Report& report);

}  // namespace loopbench
