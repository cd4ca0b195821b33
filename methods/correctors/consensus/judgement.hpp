/// Judgement of the loop closures of a problem, and of its stated covariances, without a reference.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench::methods {

/// What a closure is found to be.
enum class ClosureFinding {
  agrees,       ///< with the odometry under the estimated factors, and with the others that agree
  contradicts,  ///< the closures that agree exclude it
  slipped,      ///< they exclude it, but it would be likely with a larger deviation
  unchecked,    ///< nothing was decided
};
inline auto choices(ClosureFinding) {
  return std::array{std::pair{"agrees", ClosureFinding::agrees},
                    std::pair{"contradicts", ClosureFinding::contradicts},
                    std::pair{"slipped", ClosureFinding::slipped},
                    std::pair{"unchecked", ClosureFinding::unchecked}};
}

struct JudgedClosure {
  ClosureFinding finding = ClosureFinding::unchecked;
  /// Log odds of true over the likeliest outlier, given all others that agree [-].
  double log_odds = 0.0;
  double metres = 0.0;   ///< error against the prediction by all others that agree
  double degrees = 0.0;  ///< of the rotation
};

/// Factors on stated standard deviations [-]. The rotation's was right within a factor of 2 in most
/// cases where it `is_known`; the translation's only shows a direction, because drift is not white.
struct EstimatedFactors {
  double translation = 1.0;  ///< of the odometry
  double rotation = 1.0;     ///< of the odometry
  double closures = 1.0;
  bool is_rotation_known = false;
};

/// A step of the odometry that is wrong: the closures that agree exclude its stated deviations
/// under the estimated factors, so that its own are `inflation` times as large.
struct FreedStep {
  std::size_t from = 0;    ///< keyframe; the step ends at the next
  double inflation = 0.0;  ///< 10, 30 or 100; infinity: the motion is unknown, as in a new map
  double log_odds = 0.0;   ///< of the explanation with this step freed over the best without [-]
  double metres = 0.0;     ///< error of the odometry against the solution with the step freed
  double degrees = 0.0;    ///< of the rotation
};

enum class ConsensusOutcome {
  decided,
  few,    ///< the closures that agree are not enough evidence
  rival,  ///< closures that contradict them agree with each other almost as well
  none,   ///< no closure is likelier true than false
};
inline auto choices(ConsensusOutcome) {
  return std::array{std::pair{"decided", ConsensusOutcome::decided},
                    std::pair{"few", ConsensusOutcome::few},
                    std::pair{"rival", ConsensusOutcome::rival},
                    std::pair{"none", ConsensusOutcome::none}};
}

struct ClosureJudgement {
  ConsensusOutcome outcome = ConsensusOutcome::none;
  std::vector<JudgedClosure> closures;  ///< one per closure of the problem
  std::vector<FreedStep> steps;         ///< ascending in `from`; empty if the odometry is right
  EstimatedFactors factors;
  double evidence = 0.0;         ///< log odds of the closures that agree over uniform ones [-]
  double evidence_needed = 0.0;  ///< to decide, and above that of a rival [-]
  std::optional<double> rival_evidence;  ///< of the best set among the others; unset: none
  std::size_t agreeing = 0;              ///< closures
  std::size_t more_needed = 0;           ///< estimate of further agreeing closures to decide

  bool is_decided() const { return outcome == ConsensusOutcome::decided; }
};

/// A fault of a problem, and a remark about the method, which follows it: ": use pose_graph".
struct NotJudged {
  std::string cause;  ///< empty: no fault
  std::string remark = {};

  std::string text() const { return cause + remark; }
};

/// The fault for which judge_closures() does not apply.
NotJudged not_judged(const Problem& problem);

/// Returns why judge_closures() does not apply, or an empty text: no closures, edges that
/// change the scale, keyframes that are not connected, or odometry between fewer than half of them.
std::string why_not_judged(const Problem& problem);

/// Estimates which closures agree and by which factors the stated deviations are wrong, together.
///
/// A closure is true, with the stated covariance times an unknown factor, or an outlier: uniform
/// over the map, or slipped. From several starting factors, the closures are added that are
/// likelier true given those before, and the factors are fitted to them, in turn; the explanation
/// of the highest posterior density wins. A step of the odometry competes with the closures that
/// contradict it: it may have 10, 30 or 100 times its deviation, or unknown motion; it is freed if
/// that is 100 times likelier than any explanation without. The best explanation is accepted if its
/// evidence exceeds `evidence_needed`, and exceeds that of the best explanation of the other
/// closures by as much. Where a step has no odometry, or only such that states no
/// rotation (unknown_motion.hpp), its motion is unknown.
///
/// At most a bounded number of closures, evenly chosen, take part in the search; the others are
/// then compared with the result, so that the cost is bounded: O(keyframes + closures), with a
/// large constant. Where closures of the search are dropped, the set is also built anew from all,
/// and the likelier one stays. Anchors are not used. Deterministic. Requires why_not_judged() to be
/// empty. No reference is used.
ClosureJudgement judge_closures(const Problem& problem);

/// The problem with the closures that agree, its information divided by the squared factors and
/// that of a freed step by its inflation; the edge is left out where its motion is unknown, and
/// anchors always. Steps without odometry get an edge with the keyframes' motion and a wide
/// covariance if their parts would be unconnected otherwise.
Problem agreed_problem(const Problem& problem, const ClosureJudgement& judgement);

}  // namespace loopbench::methods
