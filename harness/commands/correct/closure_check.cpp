#include "harness/commands/correct/closure_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "datasets/core/closure_parts.hpp"
#include "datasets/core/fields.hpp"
#include "harness/commands/loops/loop_json.hpp"
#include "harness/sweep/text/counted.hpp"
#include "methods/correctors/consensus/judgement_text.hpp"

namespace loopbench::harness {
namespace {

using methods::ClosureFinding;
using methods::ClosureJudgement;

/// "; freed steps of the odometry: ...; estimated standard deviations: ..."
std::string details(const ClosureJudgement& found, const Problem& problem) {
  const std::string steps = methods::freed_steps_text(problem, found);
  return (steps.empty() ? "" : "; steps of the odometry that are wrong and were freed: " + steps) +
         "; estimated standard deviations: " + methods::deviations_text(found.factors);
}

/// "4 of 5 closures are used".
std::string used_text(std::size_t used, std::size_t all) {
  return fmt::format("{} of {} {} used", used, counted(all, "closure"), used == 1 ? "is" : "are");
}

/// A slip along the path hides in its drift, unless a closure at another place contradicts it.
std::string one_place_text(const ClosureJudgement& found, const Problem& problem) {
  std::vector<Edge> used;
  for (std::size_t k = 0; k < found.closures.size(); ++k) {
    if (found.closures[k].finding == ClosureFinding::agrees) used.push_back(problem.closures[k]);
  }
  if (!problem.anchors.empty() || used.empty() || closure_parts(used).size() > 1) return "";
  return used.size() == 1 ? "; no other place predicts it, so a slip along the path stays unnoticed"
                          : "; they are at one place, so a slip along the path that they share "
                            "stays unnoticed";
}

/// Consensus followed the check.
CheckSentence of_consensus(const ClosureJudgement& found, const Problem& problem) {
  if (!found.is_decided()) {
    const char* const what =
        problem.anchors.empty() ? "the path is unchanged" : "no closure is used";
    return {fmt::format("{} because {}. --trust-loops uses all closures anyway.",
                        what,
                        methods::undecided_text(found)),
            true};
  }
  const std::vector<std::size_t> dropped = methods::disagreeing_closures(found);
  std::string out =
      used_text(found.agreeing, problem.closures.size()) + one_place_text(found, problem);
  if (!dropped.empty()) {
    out += "; dropped: " + methods::disagreeing_text(problem, found, dropped);
  }
  return {out + details(found, problem)};
}

/// Another method chose the closures.
CheckSentence of_other(const ClosureCheck& check, const Problem& problem, const ClosureUse& use) {
  const ClosureJudgement& found = *check.judgement;
  const std::size_t all = problem.closures.size(), used = all - use.rejected.size();
  std::string out = used_text(used, all) + " by " + use.method;
  if (!found.is_decided()) {
    return {out + "; whether they are true is not decided: " + methods::undecided_text(found)};
  }
  const std::vector<std::size_t> wrong = disagreeing_used(check, use);
  if (!wrong.empty()) {
    out += fmt::format("; {} of them {} with the others: {}; --method consensus drops {}",
                       wrong.size(),
                       wrong.size() == 1 ? "disagrees" : "disagree",
                       methods::disagreeing_text(problem, found, wrong),
                       wrong.size() == 1 ? "it" : "them");
  }
  const auto lost = std::ranges::count_if(use.rejected, [&](std::size_t k) {
    return found.closures[k].finding == ClosureFinding::agrees;
  });
  if (lost > 0) out += fmt::format("; {} of those rejected agree with the others", lost);
  if (wrong.empty() && lost == 0) out += "; they agree";
  const std::string steps = methods::freed_steps_text(problem, found);
  if (!steps.empty()) {
    out += "; steps of the odometry are wrong: " + steps + "; --method consensus frees them";
  }
  out += "; estimated standard deviations: " + methods::deviations_text(found.factors);
  return {out, !wrong.empty() || !steps.empty()};
}

nlohmann::json factors_json(const methods::EstimatedFactors& factors) {
  return {{"rotation", factors.is_rotation_known ? nlohmann::json(factors.rotation) : nullptr},
          {"rotation_direction", methods::direction_text(factors.rotation)},
          {"translation", methods::direction_text(factors.translation)}};
}

}  // namespace

ClosureCheck check_closures(const Problem& problem) {
  ClosureCheck out;
  const methods::NotJudged fault = methods::not_judged(problem);
  out.why_not = fault.text();
  out.cause = fault.cause;
  if (!fault.cause.empty()) return out;
  try {
    out.judgement = std::make_shared<ClosureJudgement>(methods::judge_closures(problem));
  } catch (const std::runtime_error& error) {
    out.why_not = out.cause = error.what();
  }
  return out;
}

std::vector<std::size_t> disagreeing_used(const ClosureCheck& check, const ClosureUse& use) {
  if (!check.is_decided()) return {};
  std::vector<std::size_t> out = methods::disagreeing_closures(*check.judgement);
  std::erase_if(out, [&](std::size_t k) { return std::ranges::binary_search(use.rejected, k); });
  return out;
}

CheckSentence sentence(const ClosureCheck& check, const Problem& problem, const ClosureUse& use) {
  if (check.judgement == nullptr) {
    return {fmt::format(
        "{} by {}; they were not checked: {}",
        used_text(problem.closures.size() - use.rejected.size(), problem.closures.size()),
        use.method,
        check.cause)};
  }
  return use.is_consensus ? of_consensus(*check.judgement, problem) : of_other(check, problem, use);
}

nlohmann::json json(const ClosureCheck& check, const Problem& problem) {
  if (check.judgement == nullptr) return {{"checked", false}, {"why_not", check.why_not}};
  const ClosureJudgement& found = *check.judgement;
  nlohmann::json closures = nlohmann::json::array();
  for (std::size_t k = 0; k < found.closures.size(); ++k) {
    const methods::JudgedClosure& each = found.closures[k];
    closures.push_back({{"from", keyframe_json(problem, problem.closures[k].from)},
                        {"to", keyframe_json(problem, problem.closures[k].to)},
                        {"finding", loopbench::to_text(each.finding)},
                        {"log_odds", each.log_odds},
                        {"metres", each.metres},
                        {"degrees", each.degrees}});
  }
  return {
      {"checked", true},
      {"why_not", nullptr},
      {"outcome", loopbench::to_text(found.outcome)},
      {"agreeing", found.agreeing},
      {"more_needed", found.more_needed},
      {"evidence", found.evidence},
      {"evidence_needed", found.evidence_needed},
      {"rival_evidence", found.rival_evidence ? nlohmann::json(*found.rival_evidence) : nullptr},
      {"deviations", factors_json(found.factors)},
      {"steps", steps_json(problem, found.steps)},
      {"closures", closures}};
}

}  // namespace loopbench::harness
