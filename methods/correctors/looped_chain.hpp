/// An odometry chain with loops, solved in closed form for the loop multipliers.
#pragma once

#include <optional>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/correctors/loop_equations.hpp"
#include "methods/report.hpp"

namespace loopbench::methods {

/// State of the chain at its current corrections: poses and errors e_i. Positions are relative to
/// the chain's centroid, because adjoints grow with the distance from the origin and lose
/// precision. Keeps references to the problem, and does not use its anchors.
class LoopedChain {
 public:
  /// `points`: empty, or one entry per closure. A closure with a point b measures only a position:
  /// eta = [R_from' (p_to + R_to b - p_from) - t; 0], and its information of the rotation has no
  /// effect. See AnchoredChain (dual.cpp).
  LoopedChain(const Problem& problem,
              NoiseModel noise_model,
              std::vector<std::optional<Vector3>> points = {});

  /// Returns half of sum e' S^-1 e + sum eta' S_L^-1 eta. A cost that is not finite makes the chain
  /// unusable as a start.
  double cost() const { return cost_; }

  /// Replaces the noise model and keeps poses and errors.
  void set_noise_model(NoiseModel noise_model);

  /// Replaces the errors e_i, one per odometry edge.
  void set_errors(std::vector<Twist> errors);

  /// Takes one step that lowers the cost, or keeps it to rounding; returns false when none is
  /// found. Uses Gauss-Newton with step halving, and Newton (newton_direction()) once a step no
  /// longer halves the cost. A linear step leaves a nonlinear residual in the loops, and stiff
  /// loops would reject almost every step. Each candidate therefore first gets a second-order
  /// correction that closes this residual. Throws std::runtime_error when the loop equations are
  /// not positive definite. O(edges + (6 closures)^3).
  bool step();

  /// The equations at the current poses. Throws std::runtime_error when they are not positive
  /// definite.
  LoopEquations equations() const { return loop_equations(linearise(), sums_, noise_model_); }

  /// Steps until the relative change of the cost is at most `tolerance`. Returns the number of
  /// steps. Throws as step().
  int minimise(int max_iterations, double tolerance);

  LoopJacobian linearise() const;

  const LoopSums& sums() const { return sums_; }

  Trajectory keyframes() const;

  /// Poses with positions relative to the chain's centroid, as in the equations.
  const std::vector<Pose>& centred_poses() const { return poses_; }

  /// Covariance of each keyframe in fixed axes (datasets/core/covariance.hpp) to first order at the
  /// current poses: that of the open chain minus the reduction by the loops. It equals
  /// graph_covariances() at the same poses; zero for the first keyframe, and out of the plane if
  /// the problem is planar. `has_front`: the first edge is that of an AnchoredChain, which is no
  /// measurement. Throws as step(). O(edges closures + (6 closures)^3), and one factorisation.
  std::vector<Matrix6> covariances(bool has_front = false) const;

 private:
  /// State after a trial step.
  struct Candidate {
    std::vector<Twist> errors;
    std::vector<Pose> poses;
    Eigen::VectorXd loop_residuals;  ///< eta, six numbers per closure
    double cost = 0.0;
  };

  bool step_towards(const std::vector<Twist>& target,
                    const LoopEquations& equations,
                    double min_length);
  Candidate candidate(std::vector<Twist> errors) const;
  void close_loops(Candidate& trial, const LoopEquations& equations) const;
  /// The entries of LoopJacobian at the current poses.
  Matrix6 edge_jacobian(std::size_t edge) const {
    return adjoint(poses_[edge + 1]) * right_jacobian_se3(errors_[edge]);
  }
  Matrix6 loop_jacobian(std::size_t closure, const Twist& error) const;
  /// Gradient of the cost with respect to the errors e_i of the edges.
  std::vector<Twist> gradient(const LoopJacobian& jacobian) const;
  std::vector<Pose> integrate(const std::vector<Twist>& errors) const;
  Eigen::VectorXd loop_residuals(const std::vector<Pose>& poses) const;
  bool measures_position(std::size_t closure) const { return points_[closure].has_value(); }
  double cost_of(const std::vector<Twist>& errors, const Eigen::VectorXd& loop_residuals) const;

  const Problem& problem_;
  std::vector<Pose> motions_;  ///< measured by the odometry: an Edge has six times the size
  LoopSums sums_;
  NoiseModel noise_model_;
  std::vector<Pose> poses_;
  std::vector<Twist> errors_;
  std::vector<std::optional<Vector3>> points_;
  Vector3 centre_;
  double cost_ = 0.0;
  bool is_near_minimum_ = false;  ///< the last step did not halve the cost
};

/// Returns the chain at its chordal relaxation (initial_values.hpp), or nullopt if that is singular
/// to rounding or its cost is not finite.
std::optional<LoopedChain> chordal_chain(const Problem& problem, const NoiseModel& noise_model);

struct MinimumSettings {
  int max_iterations = 500;
  double tolerance = 1e-10;   ///< relative change of the cost at which a solution has converged
  bool tries_chordal = true;  ///< also from chordal relaxation, if chi2 is implausibly large
};

/// Returns the chain at the lower of the minima that are found from the keyframes and, if wanted,
/// from chordal relaxation. Adds the counts `chi2_before`, `iterations` and `chi2`, and a note if
/// there are two minima. Throws std::runtime_error when the cost is not finite, and as step().
LoopedChain lowest_minimum(const Problem& problem,
                           const NoiseModel& noise_model,
                           const MinimumSettings& settings,
                           Report& report);

}  // namespace loopbench::methods
