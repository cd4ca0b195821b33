#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "harness/sweep/model/loops.hpp"
#include "harness/sweep/text/counted.hpp"
#include "methods/correctors/consensus/anchor_text.hpp"

namespace loopbench::harness {
namespace {

using methods::ClosureLedger;
using methods::LedgerRow;
using methods::LedgerVerdict;

/// "9.40 m and 179 deg from its prediction by other places; chi2 falls by 20594 without it".
std::string error_text(const LedgerRow& row) {
  std::string out;
  if (row.predicted) {
    out = fmt::format("{} m and {} deg from its prediction by other places",
                      plain_number(row.predicted->metres),
                      plain_number(row.predicted->degrees));
  } else if (row.in_odometry) {
    out = fmt::format("{} m and {} deg from the odometry",
                      plain_number(row.in_odometry->metres),
                      plain_number(row.in_odometry->degrees));
  }
  if (!row.is_drop_solved) return out;
  return out + fmt::format("{}chi2 falls by {} without it",
                           out.empty() ? "" : "; ",
                           plain_number(row.cost_drop));
}

/// The first suspects with their errors, and how many follow of `count`.
std::string suspects_text(const LoopsResult& result, std::size_t count) {
  constexpr std::size_t kNamed = 3;
  std::string out;
  const std::size_t shown = std::min(count, kNamed);
  for (std::size_t i = 0; i < shown; ++i) {
    const std::size_t k = result.ledger.suspects[i];
    if (i > 0) out += ", then ";
    out += closure_name(result.problem, k);
    const std::string error = error_text(result.ledger.rows[k]);
    if (!error.empty()) out += " (" + error + ")";
  }
  return count > shown ? out + fmt::format(", and {} more", count - shown) : out;
}

std::string places_text(const ClosureLedger& ledger) {
  if (ledger.places < 2) {
    return fmt::format("{}, so it cannot be shown whether the correction helps.",
                       ledger.rows.size() == 1
                           ? "No other place predicts it"
                           : "They are at one place, and no other place predicts them");
  }
  const std::string out = fmt::format(
      "Each of the {} places is predicted from the others, typically with {} of the odometry's "
      "error (less at {} of {} places); {:.0f} % of the path lies in loops of at least two "
      "places. ",
      ledger.places,
      plain_number(ledger.ratio),
      ledger.better_places,
      ledger.places,
      100.0 * ledger.covered);
  return out +
         (ledger.helps
              ? "The correction probably helps; by how much is not known."
              : "This does not show whether the correction helps: closures at more places, on "
                "more of the path, would.");
}

std::string steps_text(const LoopsResult& result) {
  std::string out;
  for (const methods::FreedStep& step : result.ledger.judgement->steps) {
    out += fmt::format("{}{} ({} m, {} deg)",
                       out.empty() ? " Steps of the odometry that are wrong: " : ", ",
                       step_name(result.problem, step.from),
                       plain_number(step.metres),
                       plain_number(step.degrees));
  }
  return out.empty() ? out : out + "; `correct` frees them.";
}

/// What `wrong` closures do to the `agreeing` ones.
std::string contradiction_text(std::size_t wrong, std::size_t agreeing) {
  if (agreeing > 1) {
    return fmt::format(
        "{} with the {} that agree", wrong == 1 ? "disagrees" : "disagree", agreeing);
  }
  const std::string verb = wrong == 1 ? "contradicts" : "contradict";
  if (agreeing == 0) return verb + " the odometry";
  return verb + " the odometry and the one closure that agrees with it";
}

std::string disagreement_text(const LoopsResult& result) {
  const ClosureLedger& ledger = result.ledger;
  const std::size_t all = ledger.rows.size(), agreeing = ledger.judgement->agreeing;
  std::string out;
  if (agreeing < all) {
    out = fmt::format("{} of {} {}: {}. `correct` drops {}.",
                      all - agreeing,
                      counted(all, "closure"),
                      contradiction_text(all - agreeing, agreeing),
                      suspects_text(result, all - agreeing),
                      all - agreeing == 1 ? "it" : "them");
  }
  out += steps_text(result);
  if (out.starts_with(' ')) out.erase(0, 1);
  if (ledger.helps) out += " With the others, the correction probably helps.";
  return out;
}

std::string unchecked_text(const LoopsResult& result) {
  const ClosureLedger& ledger = result.ledger;
  const std::string count = counted(ledger.rows.size(), "closure");
  if (ledger.verdict == LedgerVerdict::unknown) {
    return count + " cannot be checked: " + ledger.why_unknown + ".";
  }
  const std::size_t more = ledger.judgement->more_needed;
  std::string remedy = " Closures at other places would decide.";
  if (more == 1) {
    remedy = " About one more, at another place, would decide if it agrees.";
  } else if (more > 1) {
    remedy = fmt::format(" About {} more, at other places, would decide if they agree.", more);
  }
  const bool is_one = ledger.rows.size() == 1;
  if (ledger.verdict == LedgerVerdict::few) {
    return fmt::format(
        "{} can be neither confirmed nor rejected.{} `correct` moves nothing without "
        "--trust-loops.",
        is_one ? "The only closure" : "The " + count,
        remedy);
  }
  const std::string suspects = suspects_text(result, std::min<std::size_t>(2, ledger.rows.size()));
  if (ledger.verdict == LedgerVerdict::rival) {
    return fmt::format(
        "Two sets of closures contradict each other, and neither is clearly more likely to be "
        "true. The most suspicious closures are {}.{} `correct` moves nothing.",
        suspects,
        remedy);
  }
  if (is_one) {
    return fmt::format(
        "The only closure contradicts the odometry: {}. The closure, the odometry (its scale) or "
        "the stated covariances can be wrong (see loopbench doctor).{} `correct` moves nothing.",
        suspects,
        remedy);
  }
  return fmt::format(
      "Odometry and closures contradict each other, most at {}. No closure confirms another, so "
      "the closures, the odometry (its scale) or the stated covariances can be wrong (see "
      "loopbench doctor).{} `correct` moves nothing.",
      suspects,
      remedy);
}

/// Closures that agree, but that nothing at another place predicts.
std::string unpredicted_text(const LoopsResult& result) {
  const ClosureLedger& ledger = result.ledger;
  if (ledger.places < 2) return "";
  std::string first;
  std::size_t count = 0;
  for (std::size_t k = 0; k < ledger.rows.size(); ++k) {
    if (ledger.rows[k].predicted) continue;
    if (count++ == 0) first = closure_name(result.problem, k);
  }
  if (count == 0) return "";
  return fmt::format(
      " No other place predicts {}. Another closure between {} keyframes, at another place, would.",
      count == 1 ? first : fmt::format("{} closures (the first is {})", count, first),
      count == 1 ? "its" : "their");
}

std::string closures_verdict(const LoopsResult& result) {
  const ClosureLedger& ledger = result.ledger;
  if (ledger.verdict == LedgerVerdict::disagrees) {
    return disagreement_text(result) + unpredicted_text(result);
  }
  if (ledger.verdict != LedgerVerdict::agrees) return unchecked_text(result);
  std::string all = fmt::format("All {} closures agree. ", ledger.rows.size());
  if (ledger.rows.size() == 1) all = "The closure agrees with the odometry. ";
  if (ledger.rows.size() == 2) all = "Both closures agree. ";
  return all + places_text(ledger) + unpredicted_text(result);
}

/// Sentences that begin with a blank.
std::string anchors_verdict(const LoopsResult& result) {
  const auto& anchors = result.ledger.anchors;
  if (!anchors) return "";
  std::string out;
  for (std::string each : {methods::consensus::anchors_text(result.problem, *anchors),
                           methods::consensus::datum_shift_text(result.problem, *anchors)}) {
    if (each.empty()) continue;
    each.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(each.front())));
    out += " " + each + ".";
  }
  return out;
}

}  // namespace

bool is_contradicted(const LoopsResult& result) {
  const auto& anchors = result.ledger.anchors;
  return methods::is_contradicted(result.ledger.verdict) ||
         (anchors &&
          (!anchors->is_decided || anchors->run || anchors->agreeing < anchors->anchors.size()));
}

std::string verdict_text(const LoopsResult& result) {
  if (result.ledger.rows.empty()) {
    return "There are no closures: anchors and odometry check each other." +
           anchors_verdict(result);
  }
  return closures_verdict(result) + anchors_verdict(result);
}

}  // namespace loopbench::harness
