/// Least-squares fit of a cumulative B-spline with fewer controls than keyframes.
#pragma once

#include "methods/method.hpp"

namespace loopbench::methods {

/// Minimises sum |p(t_i) - p_i|^2 and sum |Log(R_i' R(t_i))|^2 over the controls of the spline of
/// order k on SO(3) x R^3 (spline/curve.hpp). Smoothing is determined only by the number of knots,
/// `knots_per_keyframe` times the number of keyframes: motion faster than the knot spacing is
/// removed regardless of the noise. A value of 1 equals `b_spline`. O(n k^2) per iteration, a few
/// iterations; O(k^2) amortised per query. Source: de Boor, ch. XIV; Kim, Kim & Shin 1995; Sommer
/// et al., CVPR 2020.
class SplineRegression final : public Smoother {
 public:
  struct Options {
    int order = 4;
    double knots_per_keyframe = 0.5;
  };
  explicit SplineRegression(const Options& options) : options_(options) {}

  std::string why_declined(const Problem& problem) const override;

  /// Counts: `controls`, `iterations`, `cost` (half the sum of both terms [m^2, rad^2]).
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

template <class Visit>
void fields(SplineRegression::Options& o, Visit visit) {
  visit("order", o.order, "order of the spline (degree plus one)", Between{2, 6});
  visit("knots_per_keyframe",
        o.knots_per_keyframe,
        "number of knots per keyframe; 1 interpolates the keyframes [-]",
        Between{0.01, 1.0});
}

}  // namespace loopbench::methods
