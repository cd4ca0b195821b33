/// Residuals of measurements as functions of the controls of a cumulative B-spline on SO(3) x R^3.
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

}  // namespace loopbench::methods
