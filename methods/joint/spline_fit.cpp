#include "methods/joint/spline_fit.hpp"

#include "methods/correctors/chain.hpp"
#include "methods/smoothers/spline/basis.hpp"
#include "methods/smoothers/spline/curve.hpp"
#include "methods/solvers/spline_solver.hpp"

namespace loopbench::methods {

std::string SplineFit::why_declined(const Problem& problem) const {
  if (problem.keyframes.size() < static_cast<std::size_t>(options_.order)) {
    return std::to_string(problem.keyframes.size()) + " keyframes, fewer than the order " +
           std::to_string(options_.order);
  }
  return chain_fault(problem);
}

std::unique_ptr<const Curve> SplineFit::estimate(const Problem& problem, Report& report) const {
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
  report.count("cost_before", summary.cost_before);
  report.count("cost", summary.cost);
  if (!summary.converged) report.notes.push_back("stopped at max_iterations before convergence");
  return std::make_unique<CumulativeCurve>(basis, controls);
}

}  // namespace loopbench::methods
