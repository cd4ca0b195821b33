/// What the closures of a corrected problem state about each other and about the stated deviations.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "methods/correctors/consensus/judgement.hpp"

namespace loopbench::harness {

struct ClosureCheck {
  std::string why_not = {};  ///< why the closures cannot be judged; empty: `judgement` is set
  std::string cause = {};    ///< of that, without a remark about the method
  std::shared_ptr<const methods::ClosureJudgement> judgement = {};

  bool is_decided() const { return judgement != nullptr && judgement->is_decided(); }
};

/// What a method did with the closures.
struct ClosureUse {
  std::string method;                 ///< label
  bool is_consensus = false;          ///< it follows the check
  std::vector<std::size_t> rejected;  ///< indices of closures, ascending
};

struct CheckSentence {
  std::string text;
  bool is_warning = false;  ///< nothing is moved, or the method used closures that disagree
};

/// Judges the closures of a problem. Does not throw: a problem that cannot be judged has a reason.
ClosureCheck check_closures(const Problem& problem);

/// The closures that the method used although they disagree with the others, those with the most
/// evidence against them first. Empty if nothing was decided.
std::vector<std::size_t> disagreeing_used(const ClosureCheck& check, const ClosureUse& use);

/// How many closures were used, which were dropped and why, which steps were freed, and what the
/// deviations are compared to those stated; or why nothing is moved, and what would be needed; or
/// what was not checked. Keyframes are named by ids, or by stamps.
CheckSentence sentence(const ClosureCheck& check, const Problem& problem, const ClosureUse& use);

/// Object with keys checked, why_not (text or null), outcome, agreeing, more_needed, evidence,
/// evidence_needed, rival_evidence (number or null), deviations {rotation (number or null),
/// rotation_direction, translation}, steps [{from, to, metres, degrees, inflation (null:
/// unbounded)}] and closures [{from, to, finding, log_odds, metres, degrees}], keyframes by ids or
/// stamps.
nlohmann::json json(const ClosureCheck& check, const Problem& problem);

}  // namespace loopbench::harness
