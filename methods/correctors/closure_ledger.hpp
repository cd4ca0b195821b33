/// What the loop closures of a pose graph state about each other: how well each is predicted by
/// the others, without a reference.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/correctors/consensus/judged_anchors.hpp"
#include "methods/correctors/consensus/judgement.hpp"
#include "methods/correctors/ledger/closure_error.hpp"

namespace loopbench::methods {

/// Change of the keyframes' positions without a closure.
struct Moves {
  double rms = 0.0;    ///< [m]
  double max = 0.0;    ///< [m]
  std::size_t at = 0;  ///< keyframe of the largest change
};

struct LedgerRow {
  std::size_t place = 0;                    ///< of the closure, in the order of closures
  std::optional<double> loop_length;        ///< distance travelled between its keyframes [m]
  std::optional<ClosureError> in_odometry;  ///< against the odometry alone; unset: it has a gap
  /// By all closures of other places that agree; unset: they do not determine it.
  std::optional<ClosureError> predicted;
  bool is_prediction_solved = false;  ///< by a solution, else to first order at one with it
  double cost_drop = 0.0;  ///< decrease of chi2 of the solution with all closures without it [-]
  std::optional<Moves> moves;   ///< unset: not computed, see LedgerSettings
  bool is_drop_solved = false;  ///< `cost_drop` and `moves` are of a solution without the closure
};

inline constexpr std::size_t kMinPlaces = 3;  ///< two cannot show which of them is wrong

enum class LedgerVerdict {
  agrees,     ///< all closures agree
  disagrees,  ///< some closures contradict the others, which agree
  rival,      ///< two sets contradict each other
  none,       ///< all contradict the odometry and each other
  few,        ///< they are too few to check each other
  unknown,    ///< they could not be judged
};
inline auto choices(LedgerVerdict) {
  return std::array{std::pair{"agrees", LedgerVerdict::agrees},
                    std::pair{"disagrees", LedgerVerdict::disagrees},
                    std::pair{"rival", LedgerVerdict::rival},
                    std::pair{"none", LedgerVerdict::none},
                    std::pair{"few", LedgerVerdict::few},
                    std::pair{"unknown", LedgerVerdict::unknown}};
}

/// Whether closures contradict each other or the odometry.
inline bool is_contradicted(LedgerVerdict verdict) {
  return verdict == LedgerVerdict::disagrees || verdict == LedgerVerdict::rival ||
         verdict == LedgerVerdict::none;
}

struct ClosureLedger {
  std::vector<LedgerRow> rows;        ///< one per closure of the problem
  std::vector<std::size_t> suspects;  ///< all closures, the most suspicious first
  std::size_t named = 0;              ///< the first suspects, whose numbers are solved
  std::size_t places = 0;
  std::size_t better_places = 0;  ///< whose prediction has a smaller error than the odometry
  double ratio = 1.0;    ///< geometric mean over places of predicted over odometry's error [-]
  double covered = 0.0;  ///< share of the path inside loops of two or more places [-]
  /// The closures of a place are predicted so much better by the others than by the odometry that
  /// the correction probably reduces the error.
  bool helps = false;
  std::optional<ClosureJudgement> judgement;  ///< unset: `why_unknown`
  std::string why_unknown;
  std::optional<consensus::AnchorJudgement> anchors;  ///< unset: the problem has none
  LedgerVerdict verdict = LedgerVerdict::unknown;

  ClosureFinding finding(std::size_t closure) const {
    const bool is_decided = judgement && judgement->is_decided();
    return is_decided ? judgement->closures[closure].finding : ClosureFinding::unchecked;
  }
};

struct LedgerSettings {
  /// Called with the work that begins.
  std::function<void(const std::string&)> progress = [](const std::string&) {};
  std::size_t named = 3;  ///< suspects that are solved without; one of more than 2,000 closures
  /// Moves of all closures are computed up to this number of closures times keyframes; beyond it,
  /// of the 20 most suspicious.
  std::size_t all_moves = 500'000;
};

/// Returns why closure_ledger() does not apply, or an empty text: edges that change the scale,
/// keyframes that are not connected, neither closures nor anchors.
std::string why_no_ledger(const Problem& problem);

/// Judges the closures (judge_closures()) and computes the ledger, with the stated covariances.
///
/// Predictions are those of the solution with the closures that agree, if the judgement decides,
/// else with all: of a closure in it, without those of its place (closure_parts()), to first order;
/// of others by the solution itself. `cost_drop` and `moves` compare the solution with all closures
/// with that without the closure: solved for the first suspects if closures contradict each other,
/// else to first order. Anchors take part in all solutions, and not in the judgement unless it uses
/// them. Without closures the anchors are judged alone. Errors that all closures share are not
/// visible. Requires why_no_ledger() to be empty.
/// Throws std::runtime_error if a solution fails. A few factorisations of the graph, and one for
/// each named suspect.
ClosureLedger closure_ledger(const Problem& problem, const LedgerSettings& settings = {});

/// The problem with the closures that agree and freed steps, with the stated covariances, and with
/// the anchors that agree; all closures, if nothing is decided.
Problem trusted_problem(const Problem& problem, const ClosureLedger& ledger);

}  // namespace loopbench::methods
