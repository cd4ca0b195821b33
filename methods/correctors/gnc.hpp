/// Graduated non-convexity: estimates inlier weights of the closures while solving.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "methods/method.hpp"
#include "methods/solvers/pose_graph_solver.hpp"

namespace loopbench::methods {

enum class Gnc { off, tls };
inline auto choices(Gnc) {
  return std::array{std::pair{"off", Gnc::off}, std::pair{"tls", Gnc::tls}};
}

struct GncProblem {
  const Problem& problem;
  PoseGraphSettings settings;
  double inlier_chi2 = 0.0;  ///< largest squared error of an inlier closure [-]
  /// Computes the initial values of a problem. A relaxation treats all its closures as inliers.
  std::function<std::vector<ScaledPose>(const Problem&)> initial;
  EliminationCache& cache;  ///< of the solves
};

struct GncSolution {
  std::vector<ScaledPose> poses;  ///< initial values of the final solve with `weights`
  std::vector<double> weights;    ///< one per closure
  int rounds = 0;
  int iterations = 0;  ///< linear solves
  double cost_before = 0.0;
};

/// Number of closures with a weight above one half; the others count as rejected.
std::size_t kept_count(const std::vector<double>& weights);
std::vector<std::size_t> rejected_closures(const std::vector<double>& weights);  ///< ascending

/// Starts from the pairwise consistent closures (consistency.hpp), with initial values computed
/// from them alone because a relaxation with false closures is biased. Starts from all closures
/// when no consistent set is available: the odometry is not a complete chain, edges change the
/// scale, or there are too many closures to compare. If that start rejects a closure, the
/// odometry's spanning tree is tried as well. All closures are also tried when the first start
/// keeps fewer than half of them. For one closure, or two that contradict each other, the odometry
/// alone is a candidate, too. Returns the solution of lowest cost, where the cost of a closure is
/// its squared error, bounded by `inlier_chi2`.
///
/// Adds the phases "check" and "graduate_weights", and a note when fewer than half of the closures
/// are kept. Throws what solve_pose_graph() throws. O(starts rounds) sparse solves.
GncSolution solve_gnc(const GncProblem& of, Report& report);

}  // namespace loopbench::methods
