/// Natural cubic spline in time through the keyframes.
#pragma once

#include "methods/method.hpp"
#include "methods/smoothers/parts.hpp"
#include "methods/smoothers/spline/through.hpp"

namespace loopbench::methods {

/// Positions: the interpolating cubic B-spline with natural ends (zero acceleration) and knots at
/// the keyframes. Rotation: a cumulative cubic B-spline on SO(3) through the keyframes with zero
/// angular acceleration at the ends (spline/interpolate.hpp), or great arcs (spline/through.hpp).
/// Both splines are C2 in time. One keyframe gives a constant, two a straight line and a great arc.
/// O(n) to construct; O(1) amortised per query for sorted times, O(log n) otherwise.
class CubicSpline final : public Smoother {
 public:
  struct Options {};
  explicit CubicSpline(const Options&) {}

  /// Counts and notes: see spline_through().
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override {
    return spline_through(problem.keyframes, report, [](const Trajectory& keyframes) {
      constexpr std::size_t kOrder = 4;
      const SplineBasis basis(kOrder, stamps(keyframes));
      return SplineControls{basis,
                            natural_controls(basis, positions_of(keyframes)),
                            natural_rotation_controls(basis, attitudes(keyframes))};
    });
  }
};

template <class Visit>
void fields(CubicSpline::Options&, Visit) {}

}  // namespace loopbench::methods
