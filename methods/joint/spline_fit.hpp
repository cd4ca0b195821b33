/// A continuous-time trajectory fitted to odometry and loop closures at once.
#pragma once

#include "methods/method.hpp"

namespace loopbench {

/// The cumulative B-spline of order k on SO(3) x R^3 (spline/curve.hpp) whose controls minimise
///
///     1/2 sum over odometry and closures of e' Omega e,   e = Log(Z^-1 X(t_from)^-1 X(t_to)),
///
/// the cost of a pose graph, with the first keyframe held. With one knot a keyframe the poses are
/// those of the pose graph and the curve is the spline through them; with fewer, odometry is
/// smoothed as its information allows, and motion that the knots cannot follow raises the cost.
/// Edges must join every two neighbours. Closures are all believed. Starts from the keyframes.
/// O(n k^2) an iteration and the fill-in of the closures; O(k^2) amortised to ask.
/// Source: Furgale, Barfoot & Sibley 2012; Sommer et al., CVPR 2020; Cioffi, Cieslewski &
/// Scaramuzza 2022 on when it pays.
class SplineFit final : public Method {
 public:
  struct Options {
    int order = 4;
    double knots_per_keyframe = 1.0;
    int max_iterations = 100;
  };
  explicit SplineFit(const Options& options) : options_(options) {}

  std::optional<std::string> declines(const Problem& problem) const override;

  /// Counts: `controls`, `iterations`, `cost_before`, `cost` (chi^2 / 2).
  std::unique_ptr<const Curve> estimate(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

template <class Visit>
void fields(SplineFit::Options& o, Visit visit) {
  visit("order", o.order, "of the spline, its degree plus one", Between{4, 6});
  visit("knots_per_keyframe", o.knots_per_keyframe, "fewer smooth more", Between{0.01, 1.0});
  visit("max_iterations", o.max_iterations, "of Levenberg-Marquardt", Between{1, 1000});
}

}  // namespace loopbench
