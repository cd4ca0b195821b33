#include "methods/correctors/ledger/solution.hpp"

#include "methods/correctors/anchors.hpp"
#include "methods/correctors/pose_graph.hpp"

namespace loopbench::methods {
namespace {

LedgerSolution solution_from(const Problem& problem, PoseGraphOptimizer::Start start) {
  const UsedAnchors used(problem);
  PoseGraphOptimizer::Options options;
  options.start = start;
  Report report;
  LedgerSolution out;
  for (const StampedPose& each : PoseGraphOptimizer(options).correct(problem, report)) {
    out.poses.push_back({each.world_from_body, 1.0});
  }
  for (const Count& each : report.counts) {
    if (each.name == "chi2") out.chi2 = each.value;
  }
  out.settings.group = problem.planar ? Group::se2 : Group::se3;
  out.settings.anchors = used.anchors;
  out.settings.is_first_free = used.is_first_free;
  return out;
}

}  // namespace

LedgerSolution ledger_solution(const Problem& problem) {
  constexpr double kImplausible = 3.0;  // chi2 per residual
  LedgerSolution out = solution_from(problem, PoseGraphOptimizer::Start::chordal);
  const double residuals =
      (problem.planar ? 3.0 : 6.0) * static_cast<double>(problem.closures.size()) +
      3.0 * static_cast<double>(problem.anchors.size());
  if (out.chi2 <= kImplausible * residuals) return out;
  try {
    LedgerSolution other = solution_from(problem, PoseGraphOptimizer::Start::keyframes);
    if (other.chi2 < out.chi2) return other;
  } catch (const std::runtime_error&) {  // one minimum is enough
  }
  return out;
}

}  // namespace loopbench::methods
