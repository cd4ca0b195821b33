#include "methods/smoothers/spline_regression.hpp"

#include "methods/smoothers/spline/basis.hpp"
#include "methods/smoothers/spline/curve.hpp"
#include "methods/solvers/spline_solver.hpp"

namespace loopbench::methods {

std::string SplineRegression::why_declined(const Problem& problem) const {
  if (problem.keyframes.size() >= static_cast<std::size_t>(options_.order)) return "";
  return std::to_string(problem.keyframes.size()) + " keyframes, fewer than the order " +
         std::to_string(options_.order);
}

std::unique_ptr<const Curve> SplineRegression::smooth(const Problem& problem,
                                                      Report& report) const {
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
  report.count("cost", summary.cost);
  if (!summary.converged)
    report.notes.push_back("stopped at the iteration limit before convergence");
  return std::make_unique<CumulativeCurve>(basis, controls);
}

}  // namespace loopbench::methods
