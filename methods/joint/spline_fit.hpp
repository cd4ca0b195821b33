/// Fits a continuous-time trajectory to odometry and loop closures jointly.
#pragma once

#include "methods/correctors/chain.hpp"
#include "methods/method.hpp"
#include "methods/smoothers/runs/parts.hpp"
#include "methods/smoothers/spline/curve.hpp"
#include "methods/solvers/spline_solver.hpp"

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

  std::string why_declined(const Problem& problem) const override {
    const auto least = static_cast<std::size_t>(options_.order);
    std::string why = too_few_keyframes(problem.keyframes, least);
    return why.empty() ? why_no_chain(problem) : why;
  }

  /// Counts: `controls`, `iterations`, `chi2_before`, `chi2`.
  std::unique_ptr<const Curve> estimate(const Problem& problem, Report& report) const override {
    const Trajectory& keyframes = problem.keyframes;
    const SplineBasis basis = basis_with_fewer_knots(
        static_cast<std::size_t>(options_.order), stamps(keyframes), options_.knots_per_keyframe);
    // The cost does not depend on the world frame. Near the origin the rounding error is small.
    const Pose world_from_start = keyframes.front().world_from_body;
    std::vector<Pose> controls = initial_controls_for(basis, keyframes);
    for (Pose& control : controls) control = normalized(world_from_start.inverse() * control);
    SplineProblem fit;
    fit.fix_start = true;
    for (const std::vector<Edge>* edges : {&problem.odometry, &problem.closures}) {
      for (const Edge& edge : *edges) {
        fit.edges.push_back({keyframes[edge.from].stamp, keyframes[edge.to].stamp, edge});
      }
    }
    const SplineSummary summary = solve_spline(basis, controls, fit, options_.max_iterations);
    for (Pose& control : controls) control = normalized(world_from_start * control);
    report.count("controls", static_cast<double>(controls.size()));
    report.count("iterations", summary.iterations);
    report.count("chi2_before", 2.0 * summary.cost_before);
    report.count("chi2", 2.0 * summary.cost);
    if (!summary.converged) report.notes.push_back("stopped at max_iterations before convergence");
    return std::make_unique<CumulativeCurve>(basis, controls);
  }

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
