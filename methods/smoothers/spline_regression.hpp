/// Least-squares fit of a cumulative B-spline with fewer controls than keyframes.
#pragma once

#include "methods/method.hpp"
#include "methods/smoothers/runs/parts.hpp"
#include "methods/smoothers/spline/curve.hpp"
#include "methods/solvers/spline_solver.hpp"

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

  std::string why_declined(const Problem& problem) const override {
    return too_few_keyframes(problem.keyframes, static_cast<std::size_t>(options_.order));
  }

  /// Counts: `controls`, `iterations`, `chi2` (the sum of both terms [m^2, rad^2]).
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override {
    const Trajectory& keyframes = problem.keyframes;
    const SplineBasis basis = basis_with_fewer_knots(
        static_cast<std::size_t>(options_.order), stamps(keyframes), options_.knots_per_keyframe);
    std::vector<Pose> controls = initial_controls_for(basis, keyframes);
    SplineProblem fit;
    // Positions relative to the first keyframe, to avoid rounding errors far from the world origin.
    const Vector3 origin = keyframes.front().world_from_body.translation;
    for (Pose& control : controls) control.translation -= origin;
    for (const auto& [stamp, pose] : keyframes) {
      fit.poses.push_back({stamp, {pose.rotation, pose.translation - origin}});
    }
    const SplineSummary summary = solve_spline(basis, controls, fit);
    for (Pose& control : controls) control.translation += origin;
    report.count("controls", static_cast<double>(controls.size()));
    report.count("iterations", summary.iterations);
    report.count("chi2", 2.0 * summary.cost);
    if (!summary.converged) {
      report.notes.push_back("stopped at the iteration limit before convergence");
    }
    return std::make_unique<CumulativeCurve>(basis, controls);
  }

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
