/// Fits a continuous-time trajectory to odometry and loop closures jointly.
#pragma once

#include "methods/method.hpp"

namespace loopbench::methods {

/// Cumulative B-spline of order k on SO(3) x R^3 (spline/curve.hpp) whose controls minimise
///
///     1/2 sum over odometry and closures of e' Omega e,   e = Log(Z^-1 X(t_from)^-1 X(t_to)),
///
/// the cost of a pose graph with the first keyframe fixed. With one knot per keyframe the poses are
/// those of the pose graph and the curve is the spline through them. With fewer knots the odometry
/// is smoothed according to its information, and motion faster than the knot spacing raises the
/// cost. Odometry edges must join all neighbouring keyframes. All closures are used without outlier
/// rejection. The initial values are the keyframes. O(n k^2) per iteration plus the fill-in of the
/// closures; O(k^2) amortised per query. Sources: Furgale, Barfoot & Sibley 2012; Sommer et al.,
/// CVPR 2020; Cioffi, Cieslewski & Scaramuzza 2022 (comparison with discrete-time optimisation).
class SplineFit final : public Estimator {
 public:
  struct Options {
    int order = 4;
    double knots_per_keyframe = 1.0;
    int max_iterations = 100;
  };
  explicit SplineFit(const Options& options) : options_(options) {}

  std::string why_declined(const Problem& problem) const override;

  /// Counts: `controls`, `iterations`, `cost_before`, `cost` (chi^2 / 2).
  std::unique_ptr<const Curve> estimate(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

template <class Visit>
void fields(SplineFit::Options& o, Visit visit) {
  visit("order", o.order, "order of the spline (degree plus one)", Between{4, 6});
  visit("knots_per_keyframe",
        o.knots_per_keyframe,
        "number of knots per keyframe; smaller values smooth more [-]",
        Between{0.01, 1.0});
  visit("max_iterations",
        o.max_iterations,
        "maximum number of Levenberg-Marquardt iterations",
        Between{1, 1000});
}

}  // namespace loopbench::methods
