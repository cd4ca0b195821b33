#include "methods/correctors/consensus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "methods/correctors/anchors.hpp"
#include "methods/correctors/consensus/anchor_judgement.hpp"
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

/// The anchors that are dropped, those with the most evidence against them first; at most five.
std::string dropped_text(const Problem& problem, const AnchorJudgement& found) {
  constexpr std::size_t kMostListed = 5;
  std::vector<std::size_t> dropped;
  for (std::size_t i = 0; i < found.anchors.size(); ++i) {
    if (!found.anchors[i].agrees) dropped.push_back(i);
  }
  std::ranges::stable_sort(dropped, {}, [&](std::size_t i) { return found.anchors[i].log_odds; });
  std::string out;
  for (std::size_t i = 0; i < std::min(dropped.size(), kMostListed); ++i) {
    out += fmt::format("{}{} ({:.3g} m)",
                       i == 0 ? "" : ", ",
                       problem.name_of(problem.anchors[dropped[i]].keyframe),
                       found.anchors[dropped[i]].metres);
  }
  if (dropped.size() <= kMostListed) return out;
  return out + fmt::format(" and {} more", dropped.size() - kMostListed);
}

/// A motion that all anchors share against the keyframes is followed, because their frames are
/// often different, but stated where it is the larger part of their errors.
void note_datum_shift(const Problem& problem, const Problem& agreed, Report& report) {
  constexpr double kLarger = 3.0;
  Problem frames = problem;
  frames.anchors = agreed.anchors;
  const UsedAnchors used(frames);
  if (!used.is_first_free) return;
  const Pose motion = used.alignment(problem.keyframes);
  double before = 0.0, after = 0.0;
  Vector3 centre = Vector3::Zero();
  for (const Anchor& anchor : used.anchors) {
    const Pose& pose = problem.keyframes[anchor.keyframe].world_from_body;
    before += anchor_error(anchor, pose).squaredNorm();
    after += anchor_error(anchor, motion * pose).squaredNorm();
    centre += pose.translation / static_cast<double>(used.anchors.size());
  }
  if (!(before > kLarger * kLarger * after)) return;
  report.notes.push_back(
      fmt::format("the anchors are shifted against the keyframes by {:.3g} m and {:.3g} degrees, "
                  "all by the same motion: the result is in their frame",
                  (motion * centre - centre).norm(),
                  log_so3(motion.rotation).norm() * 180.0 / M_PI));
}

/// Adds the anchors that agree to the problem that will be solved. Returns whether there are any.
bool add_anchors(const Problem& problem, bool is_calibrated, Problem& agreed, Report& report) {
  if (problem.anchors.empty()) return false;
  agreed.anchors = problem.anchors;
  const AnchorJudgement found =
      report.time("judge anchors", [&] { return consensus::judge_anchors(agreed, is_calibrated); });
  report.count("anchors_kept", found.is_decided ? static_cast<double>(found.agreeing) : 0.0);
  report.count("factor_anchors", found.factor);
  const std::size_t all = problem.anchors.size();
  if (!found.is_decided) {
    agreed.anchors.clear();
    report.notes.push_back(fmt::format(
        "no anchor is used: {} of {} agree with each other, log odds {:.3g}; more than half, and "
        "odds of ln 100 = 4.6 would decide (pose_graph uses all)",
        found.agreeing,
        all,
        found.evidence));
    return false;
  }
  consensus::use_agreeing_anchors(problem, found, agreed);
  if (found.agreeing < all) {
    report.notes.push_back(fmt::format(
        "{} of {} anchors are used; dropped, with the distance from what the others predict: {}",
        found.agreeing,
        all,
        dropped_text(problem, found)));
  }
  note_datum_shift(problem, agreed, report);
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
