#include "methods/correctors/consensus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "methods/correctors/consensus/anchor_judgement.hpp"
#include "methods/correctors/consensus/anchor_text.hpp"
#include "methods/correctors/consensus/judgement_text.hpp"
#include "methods/correctors/consensus/odometry_fault.hpp"
#include "methods/correctors/pose_graph.hpp"

namespace loopbench::methods {
namespace {

using consensus::AnchorJudgement;

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

/// Adds the anchors that agree to the problem that will be solved. Returns whether there are any.
bool add_anchors(const Problem& problem, bool is_calibrated, Problem& agreed, Report& report) {
  if (problem.anchors.empty()) return false;
  agreed.anchors = problem.anchors;
  const AnchorJudgement found =
      report.time("judge anchors", [&] { return consensus::judge_anchors(agreed, is_calibrated); });
  report.count("anchors_kept", found.is_decided ? static_cast<double>(found.agreeing) : 0.0);
  report.count("factor_anchors", found.factor);
  if (!found.is_decided) {
    agreed.anchors.clear();
    report.notes.push_back(consensus::anchors_text(problem, found));
    return false;
  }
  consensus::use_agreeing_anchors(problem, found, agreed);
  if (found.agreeing < problem.anchors.size()) {
    report.notes.push_back(consensus::anchors_text(problem, found));
  }
  if (std::string shift = consensus::datum_shift_text(problem, found); !shift.empty()) {
    report.notes.push_back(std::move(shift));
  }
  return true;
}

}  // namespace

std::string Consensus::why_declined(const Problem& problem) const {
  const bool has_anchors_alone = problem.closures.empty() && !problem.anchors.empty();
  return has_anchors_alone ? why_no_odometry(problem) : why_not_judged(problem);
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
  // Without closures, or if they do not decide, the odometry alone.
  ClosureJudgement used = found;
  if (!found.is_decided()) {
    used = {};
    used.closures.resize(problem.closures.size());
  }
  const bool is_calibrated = found.is_decided() && found.evidence > 0.0;
  Problem agreed = agreed_problem(problem, used);
  const bool has_anchors = add_anchors(problem, is_calibrated, agreed, report);
  if (!found.is_decided() && notes_undecided_) {
    report.notes.push_back(undecided_text(found) + (has_anchors
                                                        ? ": closures are not used"
                                                        : ": keyframes returned unchanged"));
  }
  if (agreed.anchors.empty() && agreed.closures.empty()) return problem.keyframes;
  PoseGraphOptimizer::Options options;
  options.start = PoseGraphOptimizer::Start::chordal;
  options.covariances = options_.covariances;
  options.gravity = options_.gravity;
  return PoseGraphOptimizer(options).correct(agreed, report);
}

}  // namespace loopbench::methods
