/// Linearised equations of a chain's loops: residuals of the closures as a function of the errors
/// of the odometry, and Newton steps.
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench::methods {

/// Stores running sums only at loop begins and ends, so memory is O(loops) instead of O(edges).
class LoopSums {
 public:
  explicit LoopSums(const std::vector<Edge>& closures) {
    for (const Edge& loop : closures) {
      cuts_.push_back(loop.from);
      cuts_.push_back(loop.to);
    }
    std::ranges::sort(cuts_);
    cuts_.erase(std::unique(cuts_.begin(), cuts_.end()), cuts_.end());
    for (const Edge& loop : closures) {
      begin_.push_back(index_of(loop.from));
      end_.push_back(index_of(loop.to));
    }
  }

  std::size_t loops() const { return begin_.size(); }
  const std::vector<std::size_t>& cuts() const { return cuts_; }

  /// Sum over the edges of a loop. `running` holds the sum over the edges before each of cuts().
  template <class T>
  T over(const std::vector<T>& running, std::size_t loop) const {
    return running[end_[loop]] - running[begin_[loop]];
  }

  bool overlap(std::size_t k, std::size_t l) const {
    return std::max(begin_[k], begin_[l]) < std::min(end_[k], end_[l]);
  }

  template <class T>
  T over_both(const std::vector<T>& running, std::size_t k, std::size_t l) const {
    return running[std::min(end_[k], end_[l])] - running[std::max(begin_[k], begin_[l])];
  }

 private:
  std::size_t index_of(std::size_t keyframe) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(cuts_, keyframe) - cuts_.begin());
  }

  std::vector<std::size_t> cuts_;   ///< ascending keyframes
  std::vector<std::size_t> begin_;  ///< per loop, an index into cuts_
  std::vector<std::size_t> end_;
};

/// Noise model of a chain. The error e_i of odometry edge i, in X_i = X_{i-1} Z_i Exp(e_i), is
/// e_i ~ N(0, S_i).
struct NoiseModel {
  std::vector<Matrix6> covariance;           ///< S_i
  std::vector<Matrix6> information;          ///< S_i^-1
  std::vector<Matrix6> closure_covariance;   ///< of a closure's twist error
  std::vector<Matrix6> closure_information;  ///< inverse of closure_covariance
};

/// Returns the stated covariances of the problem's edges and closures. Edges of planar problems
/// have no errors out of the plane.
NoiseModel stated_noise_model(const Problem& problem);

/// Jacobian of the closure errors with respect to the edge errors at the current poses: eta = c + A
/// e, where A_ki = loop[k] edge[i] for every edge i inside loop k and 0 outside. O(edges +
/// closures).
struct LoopJacobian {
  std::vector<Matrix6> edge;
  std::vector<Matrix6> loop;
  Eigen::VectorXd gap;  ///< c, six numbers per closure
};

/// The six entries of closure k in a vector over all closures.
template <class Vector>
auto of_closure(Vector& all, std::size_t k) {
  return all.template segment<6>(static_cast<Eigen::Index>(6 * k));
}

/// Cholesky factor of A S A' + S_L.
struct LoopEquations {
  LoopJacobian jacobian;
  Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factor;
};

/// Assembles and factorises the equations. Throws std::runtime_error when the matrix is not
/// positive definite. O(edges + (6 closures)^3).
LoopEquations loop_equations(LoopJacobian jacobian,
                             const LoopSums& sums,
                             const NoiseModel& noise_model);

/// Returns the odometry errors e_i of minimum cost for loop errors `gap` + A e. O(edges +
/// closures^2).
std::vector<Twist> minimum_cost_corrections(const LoopEquations& equations,
                                            const Eigen::VectorXd& gap,
                                            const std::vector<Edge>& closures,
                                            const NoiseModel& noise_model);

/// Returns A e. O(edges + closures).
Eigen::VectorXd loop_residual_change(const LoopJacobian& jacobian,
                                     const LoopSums& sums,
                                     const std::vector<Twist>& errors);

/// Returns increments of A' lambda along the chain: A' lambda at edge i is edge[i]' times the sum
/// of out[0] to out[i]. The size is the number of edges + 1. O(edges + closures).
std::vector<Twist> constraint_force_increments(const std::vector<Matrix6>& loop,
                                               std::size_t edges,
                                               const std::vector<Edge>& closures,
                                               const Eigen::VectorXd& lambda);

/// Returns the lower triangle of A S A'. `running` holds the sum of edge[i] S_i edge[i]' before
/// each cut. O(closures^2).
Eigen::MatrixXd propagate_covariance(const LoopJacobian& jacobian,
                                     const LoopSums& sums,
                                     const std::vector<Matrix6>& running);

/// Returns the sums of of(i) over the edges before each cut. O(edges).
template <class Of>
auto running_sum(const LoopSums& sums, Of of) {
  using Sum = decltype(of(std::size_t{0}));
  std::vector<Sum> out;
  out.reserve(sums.cuts().size());
  Sum total = Sum::Zero();
  std::size_t i = 0;
  for (const std::size_t cut : sums.cuts()) {
    for (; i < cut; ++i) total += of(i);
    out.push_back(total);
  }
  return out;
}

/// Newton step: Gauss-Newton plus the second-order term of the loops.
///
/// Gauss-Newton assumes that a loop's error eta is linear in the edge errors. With twists x_i =
/// edge[i] e_i in the world frame, a loop closes by
///
///     sum x_i + 1/2 sum_{i<j} [x_i, x_j]     (Baker, Campbell, Hausdorff),
///
/// so its multiplier lambda adds N_ij = 1/2 edge[i]' B(q) edge[j], i < j, to the Hessian. Here q is
/// the sum of loop[k]' lambda_k over the loops that enclose both edges, and x' B(q) y = q' [x, y].
/// With long lever arms this term determines the rate of convergence; without it KITTI 00 takes
/// hundreds of steps. Terms that vanish with the errors are neglected.
///
/// Solves (M + N) d = -gradient, where M is the Gauss-Newton Hessian, by conjugate gradients
/// preconditioned with M^-1. N d and M^-1 d are running sums: O(edges + closures^2) per iteration,
/// at most 50 iterations. The solver stops at negative curvature (Steihaug); its first iterate is a
/// multiple of the Gauss-Newton direction.
///
/// The unknowns are the errors of the edges; `gradient` is with respect to them. Returns the change
/// of the errors. Source: Nocedal & Wright, Numerical Optimization, 2006, sections 7.1 and 18.3.
std::vector<Twist> newton_direction(const LoopEquations& equations,
                                    const std::vector<Twist>& gradient,
                                    const LoopSums& sums,
                                    const std::vector<Edge>& closures,
                                    const NoiseModel& noise_model);

}  // namespace loopbench::methods
