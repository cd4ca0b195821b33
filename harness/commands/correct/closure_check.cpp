#include "harness/commands/correct/closure_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "datasets/core/fields.hpp"
#include "harness/sweep/model/loops.hpp"
#include "harness/sweep/text/counted.hpp"
#include "methods/correctors/consensus/judgement_text.hpp"

namespace loopbench::harness {
namespace {

using methods::ClosureFinding;
using methods::ClosureJudgement;

/// "; freed steps of the odometry: ...; deviations against those stated: ..."
std::string details(const ClosureJudgement& found, const Problem& problem) {
  const std::string steps = methods::freed_steps_text(problem, found);
  return (steps.empty() ? "" : "; steps of the odometry that are wrong and were freed: " + steps) +
         "; deviations against those stated: " + methods::deviations_text(found.factors);
}

std::string of_all(std::size_t part, std::size_t all) {
  return fmt::format("{} of {}", part, counted(all, "closure"));
}

/// Consensus followed the check.
CheckSentence of_consensus(const ClosureJudgement& found, const Problem& problem) {
  if (!found.is_decided()) {
    return {"nothing is moved: " + methods::undecided_text(found) +
                "; --trust-loops corrects with all closures",
            true};
  }
  const std::vector<std::size_t> dropped = methods::disagreeing_closures(found);
  std::string out = of_all(found.agreeing, problem.closures.size()) + " are used";
  if (!dropped.empty()) {
    out += "; dropped: " + methods::disagreeing_text(problem, found, dropped);
  }
  return {out + details(found, problem)};
}

/// A reason to decline without what it states about the method, and without its advice.
std::string cause(const std::string& why) {
  return why.substr(0, std::min(why.find(", which "), why.find(": use pose_graph")));
}

/// Another method chose the closures.
CheckSentence of_other(const ClosureCheck& check, const Problem& problem, const ClosureUse& use) {
  const ClosureJudgement& found = *check.judgement;
  const std::size_t all = problem.closures.size(), used = all - use.rejected.size();
  std::string out = of_all(used, all) + " are used by " + use.method;
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
  out += "; deviations against those stated: " + methods::deviations_text(found.factors);
  return {out, !wrong.empty() || !steps.empty()};
}

nlohmann::json name_of(const Problem& problem, std::size_t keyframe) {
  if (!problem.ids.empty()) return problem.ids[keyframe];
  return shown_stamp(problem.keyframes[keyframe].stamp);
}

nlohmann::json finite(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

nlohmann::json factors_json(const methods::EstimatedFactors& factors) {
  return {{"rotation", factors.is_rotation_known ? finite(factors.rotation) : nullptr},
          {"rotation_direction", methods::direction_text(factors.rotation)},
          {"translation", methods::direction_text(factors.translation)}};
}

}  // namespace

ClosureCheck check_closures(const Problem& problem) {
  if (std::string why = methods::why_not_judged(problem); !why.empty()) return {std::move(why)};
  try {
    return {"", std::make_shared<ClosureJudgement>(methods::judge_closures(problem))};
  } catch (const std::runtime_error& error) {
    return {error.what()};
  }
}

std::vector<std::size_t> disagreeing_used(const ClosureCheck& check, const ClosureUse& use) {
  if (!check.is_decided()) return {};
  std::vector<std::size_t> out = methods::disagreeing_closures(*check.judgement);
  std::erase_if(out, [&](std::size_t k) { return std::ranges::binary_search(use.rejected, k); });
  return out;
}

CheckSentence sentence(const ClosureCheck& check, const Problem& problem, const ClosureUse& use) {
  if (check.judgement == nullptr) {
    return {
        fmt::format("{} are used by {}; they were not checked: {}",
                    of_all(problem.closures.size() - use.rejected.size(), problem.closures.size()),
                    use.method,
                    cause(check.why_not))};
  }
  return use.is_consensus ? of_consensus(*check.judgement, problem) : of_other(check, problem, use);
}

nlohmann::json json(const ClosureCheck& check, const Problem& problem) {
  if (check.judgement == nullptr) return {{"checked", false}, {"why_not", check.why_not}};
  const ClosureJudgement& found = *check.judgement;
  nlohmann::json closures = nlohmann::json::array(), steps = nlohmann::json::array();
  for (std::size_t k = 0; k < found.closures.size(); ++k) {
    const methods::JudgedClosure& each = found.closures[k];
    closures.push_back({{"from", name_of(problem, problem.closures[k].from)},
                        {"to", name_of(problem, problem.closures[k].to)},
                        {"finding", loopbench::to_text(each.finding)},
                        {"log_odds", finite(each.log_odds)},
                        {"metres", finite(each.metres)},
                        {"degrees", finite(each.degrees)}});
  }
  for (const methods::FreedStep& each : found.steps) {
    steps.push_back({{"from", name_of(problem, each.from)},
                     {"to", name_of(problem, each.from + 1)},
                     {"metres", finite(each.metres)},
                     {"degrees", finite(each.degrees)},
                     {"inflation", finite(each.inflation)}});
  }
  return {{"checked", true},
          {"why_not", nullptr},
          {"outcome", loopbench::to_text(found.outcome)},
          {"agreeing", found.agreeing},
          {"more_needed", found.more_needed},
          {"evidence", finite(found.evidence)},
          {"evidence_needed", finite(found.evidence_needed)},
          {"rival_evidence", found.rival_evidence ? finite(*found.rival_evidence) : nullptr},
          {"deviations", factors_json(found.factors)},
          {"steps", steps},
          {"closures", closures}};
}

}  // namespace loopbench::harness
