#include "methods/correctors/consensus.hpp"

#include <fmt/format.h>

#include "methods/correctors/consensus/judgement.hpp"
#include "methods/correctors/pose_graph.hpp"

namespace loopbench::methods {
namespace {

/// Why nothing is moved, and what would be needed.
std::string undecided_text(const ClosureJudgement& of) {
  constexpr const char* kUnchanged = "keyframes returned unchanged";
  if (of.outcome == ConsensusOutcome::none) {
    return fmt::format("no closure is likelier true than false: {}", kUnchanged);
  }
  const std::string more =
      fmt::format("about {} more closures that agree would decide", of.more_needed);
  if (of.outcome == ConsensusOutcome::rival) {
    return fmt::format(
        "two sets of closures contradict each other, with log odds {:.3g} and {:.3g}: {}; {}",
        of.evidence,
        of.rival_evidence.value_or(0.0),
        kUnchanged,
        more);
  }
  return fmt::format("agreeing closures are too few: log odds {:.3g}, needed {:.3g}: {}; {}",
                     of.evidence,
                     of.evidence_needed,
                     kUnchanged,
                     more);
}

}  // namespace

std::string Consensus::why_declined(const Problem& problem) const {
  return why_not_judged(problem);
}

Trajectory Consensus::correct(const Problem& problem, Report& report) const {
  const ClosureJudgement found = report.time("judge", [&] { return judge_closures(problem); });
  report.count("decided", found.is_decided() ? 1.0 : 0.0);
  report.count("factor_t", found.factors.translation);
  report.count("factor_r", found.factors.rotation);
  report.count("factor_closures", found.factors.closures);
  report.count("evidence", found.evidence);
  report.count("rival_evidence", found.rival_evidence.value_or(0.0));
  report.count("closures_kept", found.is_decided() ? static_cast<double>(found.agreeing) : 0.0);
  report.rejected.emplace();
  for (std::size_t k = 0; k < found.closures.size(); ++k) {
    const bool is_kept = found.is_decided() && found.closures[k].finding == ClosureFinding::agrees;
    if (!is_kept) report.rejected->push_back(k);
  }
  if (!found.is_decided()) {
    report.notes.push_back(undecided_text(found));
    return problem.keyframes;
  }
  PoseGraphOptimizer::Options options;
  options.start = PoseGraphOptimizer::Start::chordal;
  options.covariances = options_.covariances;
  return PoseGraphOptimizer(options).correct(agreed_problem(problem, found), report);
}

}  // namespace loopbench::methods
