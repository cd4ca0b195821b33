#include "metrics/doctor/judged_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "methods/correctors/consensus/judgement_text.hpp"
#include "methods/correctors/consensus/repeated_closures.hpp"
#include "metrics/doctor/loop_chain.hpp"
#include "metrics/doctor/sampling.hpp"

namespace loopbench::metrics {
namespace {

constexpr std::size_t kFewestJudged = 4;  // closures that show more than their own deviations

/// Closures that agree; those that are listed twice agree exactly, which shows nothing.
std::size_t agreeing_once(const Problem& problem, const methods::ClosureJudgement& judgement) {
  const std::vector<std::size_t> same = methods::consensus::repeated_closures(problem);
  std::size_t out = 0;
  for (std::size_t k = 0; k < same.size(); ++k) {
    out += same[k] == k && judgement.closures[k].finding == methods::ClosureFinding::agrees;
  }
  return out;
}

/// Distance travelled up to each keyframe [m].
std::vector<double> distances(const Problem& problem) {
  std::vector<double> out(problem.keyframes.size(), 0.0);
  for (const Edge& edge : problem.odometry) out[edge.to] = edge.from_from_to.translation.norm();
  for (std::size_t k = 1; k < out.size(); ++k) out[k] += out[k - 1];
  return out;
}

}  // namespace

JudgedProblem::JudgedProblem(Problem problem, const methods::ClosureJudgement* known)
    : problem_(std::move(problem)) {
  if (known != nullptr) {
    judgement_ = *known;
    return;
  }
  problem_.anchors.clear();  // they are no closures
  if (methods::why_not_judged(problem_).empty()) judgement_ = methods::judge_closures(problem_);
}

bool JudgedProblem::is_as_stated() const {
  constexpr double kUsual = 3.0;      // stated deviations are mostly right within this factor
  constexpr double kNearlyAll = 0.8;  // of the closures
  // Three closures of a wrong convention can agree, with a larger deviation of their own.
  if (!is_decided() || agreeing_once(problem_, *judgement_) < kFewestJudged ||
      !judgement_->steps.empty()) {
    return false;
  }
  const methods::EstimatedFactors& of = judgement_->factors;
  return std::max({of.translation, of.rotation, of.closures}) < kUsual &&
         static_cast<double>(judgement_->agreeing) >=
             kNearlyAll * static_cast<double>(problem_.closures.size());
}

std::vector<InputFinding> JudgedProblem::findings() const {
  std::vector<InputFinding> out;
  if (!is_decided()) return out;
  const auto wrong = information();
  if (auto found = gap(!wrong)) out.push_back(std::move(*found));
  if (auto found = step()) out.push_back(std::move(*found));
  if (wrong) out.push_back(*wrong);
  return out;
}

/// Closures that are 100 times likelier outliers. Most real graphs have some with a few times their
/// deviation, which are named if they are large for their loop; small ones do little harm. Where
/// there are few, or the stated deviations are far from those found, also with a gap that no
/// odometry leaves.
std::optional<InputFinding> JudgedProblem::gap(bool is_drift_known) const {
  constexpr double kSure = 4.605170185988091;  // ln 100
  constexpr double kMostDrift = 0.35;          // of the length of a loop
  constexpr double kLeastSlip = 0.05;          // of the length of a loop
  constexpr double kLeastGap = 0.3;            // [m] or [rad]
  const bool needs_gap = !is_drift_known || problem_.closures.size() < kFewestJudged;
  const std::vector<double> at = distances(problem_);
  std::vector<std::size_t> found = methods::disagreeing_closures(*judgement_);
  std::erase_if(found, [&](std::size_t k) {
    const methods::JudgedClosure& each = judgement_->closures[k];
    const double length = at[problem_.closures[k].to] - at[problem_.closures[k].from];
    double least = each.finding == methods::ClosureFinding::slipped ? kLeastSlip * length : 0.0;
    if (needs_gap) least = kMostDrift * length;
    const bool is_small = each.metres < kLeastGap && each.degrees < kLeastGap * 180.0 / M_PI;
    return each.log_odds > -kSure || is_small || each.metres < least;
  });
  if (found.empty()) return std::nullopt;
  const double most = -judgement_->closures[found.front()].log_odds / kSure;
  return InputFinding{Fault::closure_gap,
                      fmt::format("{} of {} closures contradict the odometry or other closures: {}",
                                  found.size(),
                                  problem_.closures.size(),
                                  methods::closures_text(problem_, *judgement_, found)),
                      "check them; method consensus drops them",
                      1.0 - 1.0 / std::max(2.0, most),
                      static_cast<double>(found.size())};
}

std::optional<InputFinding> JudgedProblem::step() const {
  if (judgement_->steps.empty()) return std::nullopt;
  return InputFinding{Fault::odometry_step,
                      "the closures contradict steps of the odometry: " +
                          methods::freed_steps_text(problem_, *judgement_),
                      "check them (lost tracking, wheels that slip); method consensus frees them",
                      0.8,
                      static_cast<double>(judgement_->steps.size())};
}

std::optional<InputFinding> JudgedProblem::information() const {
  constexpr double kTooLarge = 10.0, kTooSmall = 0.01;  // drift exceeds noise
  if (agreeing_once(problem_, *judgement_) < kFewestLoops) return std::nullopt;
  const methods::EstimatedFactors& of = judgement_->factors;
  const auto is_usual = [](double factor) { return factor < kTooLarge && factor > kTooSmall; };
  // Few loops do not tell which component is wrong.
  const double odometry = std::max(of.translation, of.rotation);
  if (is_usual(odometry) && is_usual(of.closures)) return std::nullopt;
  const double found = is_usual(odometry) ? of.closures : odometry;
  return InputFinding{
      Fault::information,
      fmt::format("the gaps of {} loops do not fit the stated standard deviations (odometry: {}; "
                  "closures: {})",
                  judgement_->agreeing,
                  methods::deviations_text(of),
                  methods::direction_text(of.closures)),
      "check the information of the edges; for a trajectory: options odometry.sigma_*, "
      "closures.sigma_*",
      0.8,
      found * found};
}

}  // namespace loopbench::metrics
