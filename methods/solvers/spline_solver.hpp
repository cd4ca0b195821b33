/// Nonlinear least squares for the controls of a cumulative B-spline on SO(3) x R^3.
#pragma once

#include <optional>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/smoothers/spline/basis.hpp"

namespace loopbench::methods {

/// Pose measurement at a time: e = [p(t) - p; Log(R' R(t))].
struct PoseAt {
  double time;
  Pose pose;
};

/// Relative pose measurement between two times: e = Log(Z^-1 X(from)^-1 X(to)).
struct EdgeBetween {
  double from, to;
  Edge edge;
};

class SplineFactor {
 public:
  /// The times must lie within the breaks of the basis.
  SplineFactor(const SplineBasis& basis, const PoseAt& measured);
  SplineFactor(const SplineBasis& basis, const EdgeBetween& measured);

  /// Indices of the controls that affect the residual, ascending: k, or up to 2 k for an edge.
  const std::vector<std::size_t>& controls() const { return controls_; }

  struct Residual {
    Twist error;
    /// Derivatives by [d; a] in [p + d; Exp(a) R], in the order of controls().
    std::vector<Matrix6> by_control;
  };
  /// Evaluates the residual. `controls[i]` is the control with index controls()[i]. O(k).
  Residual evaluate(const std::vector<Pose>& controls) const;

 private:
  struct Time {
    std::size_t at;  ///< position in controls_ of the first of `order` controls
    SplineBasis::Values values, cumulative;
  };
  struct PoseDerivative;
  PoseDerivative pose_at(const Time& time, const std::vector<Pose>& controls) const;
  void collect_controls(const std::vector<std::size_t>& firsts);

  std::size_t order_;
  std::vector<std::size_t> controls_;
  Time from_{};             ///< time of a pose, or start time of an edge
  std::optional<Time> to_;  ///< end time of an edge
  Pose measured_;
};

/// Minimises half the sum of |e|^2 over poses and of e' Omega e over edges. Translation and
/// rotation of the poses share no unknown, so no weight between [m] and [rad] is needed.
struct SplineProblem {
  std::vector<PoseAt> poses;
  std::vector<EdgeBetween> edges;
  bool fix_start = false;  ///< keep the first control, the start of the curve, fixed
};

struct SplineSummary {
  int iterations = 0;
  double cost_before = 0.0;
  double cost = 0.0;
  bool converged = false;  ///< the relative change of the cost fell below 1e-16 in time
};

/// Minimises the problem over the controls, one per basis function. Levenberg-Marquardt, analytic
/// Jacobians, sparse Cholesky, one thread; results are bit-identical between
/// runs. O(n k^2) per iteration for n factors, plus the fill-in of long edges. Throws
/// std::runtime_error with the message of Ceres when there is no usable solution, and when an
/// information matrix is not positive definite.
SplineSummary solve_spline(const SplineBasis& basis,
                           std::vector<Pose>& controls,
                           const SplineProblem& problem,
                           int max_iterations = 100);

}  // namespace loopbench::methods
