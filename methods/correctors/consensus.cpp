#include "methods/correctors/consensus.hpp"

#include <fmt/format.h>

#include <cmath>

#include "methods/correctors/consensus/judgement_text.hpp"
#include "methods/correctors/pose_graph.hpp"

namespace loopbench::methods {
namespace {

std::string freed_text(const Problem& problem, const FreedStep& step) {
  const std::string as = std::isinf(step.inflation)
                             ? "its motion is treated as unknown"
                             : fmt::format("it gets {:.0f} times its deviation", step.inflation);
  return fmt::format("the odometry from {} to {} is wrong by {:.2f} m and {:.1f} degrees: {}",
                     problem.name_of(step.from),
                     problem.name_of(step.from + 1),
                     step.metres,
                     step.degrees,
                     as);
}

}  // namespace

std::string Consensus::why_declined(const Problem& problem) const {
  return why_not_judged(problem);
}

Trajectory Consensus::correct(const Problem& problem, Report& report) const {
  const bool is_known = known_ && known_->closures.size() == problem.closures.size();
  const ClosureJudgement found =
      is_known ? *known_ : report.time("judge", [&] { return judge_closures(problem); });
  report.count("decided", found.is_decided() ? 1.0 : 0.0);
  report.count("factor_t", found.factors.translation);
  report.count("factor_r", found.factors.rotation);
  report.count("factor_closures", found.factors.closures);
  report.count("evidence", found.evidence);
  report.count("rival_evidence", found.rival_evidence.value_or(0.0));
  report.count("closures_kept", found.is_decided() ? static_cast<double>(found.agreeing) : 0.0);
  report.count("steps_freed", static_cast<double>(found.steps.size()));
  for (const FreedStep& each : found.steps) report.notes.push_back(freed_text(problem, each));
  report.rejected.emplace();
  for (std::size_t k = 0; k < found.closures.size(); ++k) {
    const bool is_kept = found.is_decided() && found.closures[k].finding == ClosureFinding::agrees;
    if (!is_kept) report.rejected->push_back(k);
  }
  if (!found.is_decided()) {
    report.notes.push_back(undecided_text(found) + ": keyframes returned unchanged");
    return problem.keyframes;
  }
  PoseGraphOptimizer::Options options;
  options.start = PoseGraphOptimizer::Start::chordal;
  options.covariances = options_.covariances;
  return PoseGraphOptimizer(options).correct(agreed_problem(problem, found), report);
}

}  // namespace loopbench::methods
