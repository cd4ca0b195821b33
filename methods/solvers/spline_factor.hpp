/// What a measurement says about the controls of a cumulative B-spline on SO(3) x R^3.
#pragma once

#include <optional>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/smoothers/spline/basis.hpp"

namespace loopbench {

/// "At this time the pose was this": e = [p(t) - p; Log(R' R(t))].
struct PoseAt {
  double time;
  Pose pose;
};

/// An edge between two times: e = Log(Z^-1 X(from)^-1 X(to)).
struct EdgeBetween {
  double from, to;
  Edge edge;
};

class SplineFactor {
 public:
  /// Times within the breaks of the basis.
  SplineFactor(const SplineBasis& basis, const PoseAt& measured);
  SplineFactor(const SplineBasis& basis, const EdgeBetween& measured);

  /// The controls that have a say, ascending: k, or up to 2 k of them for an edge.
  const std::vector<std::size_t>& controls() const { return controls_; }

  struct Residual {
    Twist error;
    std::vector<Matrix6> by_control;  ///< by [d; a] in [p + d; Exp(a) R], in their order
  };
  /// `controls[i]` is the control named by controls()[i]. O(k).
  Residual evaluate(const std::vector<Pose>& controls) const;

 private:
  struct Time {
    std::size_t at;  ///< of the first of `order` controls in controls_
    SplineBasis::Values values, cumulative;
  };
  struct Here;
  Here pose_at(const Time& time, const std::vector<Pose>& controls) const;
  void name_controls(std::vector<std::size_t> firsts);

  std::size_t order_;
  std::vector<std::size_t> controls_;
  Time from_{};  ///< of a pose, or where an edge starts
  std::optional<Time> to_;
  Pose measured_;
};

}  // namespace loopbench
