/// Verdict and order of the closures of a ledger.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <numeric>
#include <string>
#include <utility>

#include "methods/correctors/closure_ledger.hpp"

namespace loopbench::methods {

/// The judgement of the closures; without the anchors if it does not use them.
inline void add_judgement(const Problem& problem, ClosureLedger& ledger) {
  std::string why = why_not_judged(problem);
  if (why.empty()) {
    ledger.judgement = judge_closures(problem);
  } else if (!problem.anchors.empty()) {
    Problem rest = problem;
    rest.anchors.clear();
    why = why_not_judged(rest);
    if (why.empty()) ledger.judgement = judge_closures(rest);
  }
  ledger.why_unknown = std::move(why);
}

inline LedgerVerdict verdict_of(const ClosureLedger& ledger) {
  if (!ledger.judgement) return LedgerVerdict::unknown;
  const ClosureJudgement& found = *ledger.judgement;
  if (found.outcome == ConsensusOutcome::none) return LedgerVerdict::none;
  if (found.outcome == ConsensusOutcome::rival) return LedgerVerdict::rival;
  if (found.outcome == ConsensusOutcome::few) return LedgerVerdict::few;
  const bool all = found.agreeing == found.closures.size() && found.steps.empty();
  return all ? LedgerVerdict::agrees : LedgerVerdict::disagrees;
}

/// Orders all closures, the most suspicious first: those that contradict the others by their
/// evidence; without a judgement, by the decrease of the cost.
inline void rank_suspects(ClosureLedger& ledger) {
  ledger.suspects.resize(ledger.rows.size());
  std::iota(ledger.suspects.begin(), ledger.suspects.end(), std::size_t{0});
  const auto sort_by = [&](auto value) {
    std::ranges::stable_sort(ledger.suspects, std::less{}, value);
  };
  if (ledger.verdict == LedgerVerdict::unknown) {
    return sort_by([&](std::size_t k) { return -ledger.rows[k].cost_drop; });
  }
  if (ledger.verdict == LedgerVerdict::none) {  // no closure has a finding
    return sort_by([&](std::size_t k) {
      const std::optional<ClosureError>& error = ledger.rows[k].in_odometry;
      return error ? -error->chi2 : 0.0;
    });
  }
  sort_by([&](std::size_t k) {
    const JudgedClosure& each = ledger.judgement->closures[k];
    return std::pair(each.finding == ClosureFinding::agrees, each.log_odds);
  });
}

/// Whether predictions of places show that the correction probably helps.
inline bool do_help(const ClosureLedger& ledger) {
  constexpr double kMinCovered = 0.3;  // below it, most of the path is checked by no prediction
  constexpr double kHelps = 0.9;       // ratio; none of 64 such chains got worse
  if (ledger.places < kMinPlaces || ledger.covered < kMinCovered) return false;
  const bool is_majority = ledger.places > kMinPlaces || ledger.better_places == kMinPlaces;
  return ledger.ratio < kHelps && is_majority;
}

}  // namespace loopbench::methods
