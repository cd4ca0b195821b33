#include "methods/correctors/consensus/judgement_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace loopbench::methods {
namespace {

constexpr std::size_t kMostListed = 5;  // in a sentence

/// Two edges in a list, with an error each.
std::string edge_text(
    const Problem& problem, std::size_t from, std::size_t to, double metres, double degrees) {
  return fmt::format("{} -> {} ({:.3g} m, {:.3g} deg)",
                     problem.name_of(from),
                     problem.name_of(to),
                     metres,
                     degrees);
}

/// `more` items follow those listed.
std::string and_more(std::size_t all) {
  return all > kMostListed ? fmt::format(" and {} more", all - kMostListed) : "";
}

}  // namespace

std::string direction_text(double factor) {
  constexpr double kDiffers = 2.0;
  if (factor > kDiffers) return "larger";
  return factor < 1.0 / kDiffers ? "smaller" : "as stated";
}

std::string deviations_text(const EstimatedFactors& factors) {
  const auto compared = [](double factor) {
    const std::string direction = direction_text(factor);
    return direction == "as stated" ? direction : direction + " than stated";
  };
  const std::string rotation =
      factors.is_rotation_known && direction_text(factors.rotation) != "as stated"
          ? fmt::format("about {:.2g} times the stated one", factors.rotation)
          : compared(factors.rotation);
  const std::string translation = compared(factors.translation);
  if (rotation == "as stated" && translation == rotation) return "as stated";
  return "rotation " + rotation + ", translation " + translation;
}

std::vector<std::size_t> disagreeing_closures(const ClosureJudgement& judgement) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < judgement.closures.size(); ++k) {
    if (judgement.closures[k].finding != ClosureFinding::agrees) out.push_back(k);
  }
  std::ranges::stable_sort(out, {}, [&](std::size_t k) { return judgement.closures[k].log_odds; });
  return out;
}

std::string closures_text(const Problem& problem,
                          const ClosureJudgement& judgement,
                          const std::vector<std::size_t>& closures) {
  std::string out;
  for (std::size_t i = 0; i < std::min(closures.size(), kMostListed); ++i) {
    const Edge& edge = problem.closures[closures[i]];
    const JudgedClosure& judged = judgement.closures[closures[i]];
    out += (i == 0 ? "" : ", ") +
           edge_text(problem, edge.from, edge.to, judged.metres, judged.degrees);
  }
  return out + and_more(closures.size());
}

std::string disagreeing_text(const Problem& problem,
                             const ClosureJudgement& judgement,
                             const std::vector<std::size_t>& closures) {
  std::vector<std::size_t> excluded, slipped;
  for (const std::size_t k : closures) {
    const bool has_slipped = judgement.closures[k].finding == ClosureFinding::slipped;
    (has_slipped ? slipped : excluded).push_back(k);
  }
  std::string out;
  if (!excluded.empty()) {
    out = closures_text(problem, judgement, excluded) + ", which the others exclude";
  }
  if (!slipped.empty()) {
    out += (out.empty() ? "" : "; ") + closures_text(problem, judgement, slipped) +
           ", whose error is larger than " + (slipped.size() == 1 ? "its" : "their") +
           " standard deviation allows";
  }
  return out;
}

std::string freed_steps_text(const Problem& problem, const ClosureJudgement& judgement) {
  std::string out;
  for (std::size_t i = 0; i < std::min(judgement.steps.size(), kMostListed); ++i) {
    const FreedStep& step = judgement.steps[i];
    out += (i == 0 ? "" : ", ") +
           edge_text(problem, step.from, step.from + 1, step.metres, step.degrees);
  }
  return out + and_more(judgement.steps.size());
}

std::string undecided_text(const ClosureJudgement& of) {
  if (of.outcome == ConsensusOutcome::none) return "no closure is more likely true than false";
  const std::string more =
      of.more_needed == 1
          ? "about one more closure that agrees would decide"
          : fmt::format("about {} more closures that agree would decide", of.more_needed);
  if (of.outcome == ConsensusOutcome::rival) {
    return fmt::format(
        "two sets of closures contradict each other, with log odds {:.3g} and "
        "{:.3g}; {}",
        of.evidence,
        of.rival_evidence.value_or(0.0),
        more);
  }
  return fmt::format("too few closures agree: log odds {:.3g}, needed {:.3g}; {}",
                     of.evidence,
                     of.evidence_needed,
                     more);
}

}  // namespace loopbench::methods
