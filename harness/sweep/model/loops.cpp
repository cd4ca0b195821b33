#include "harness/sweep/model/loops.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <stdexcept>

#include "harness/sweep/text/counted.hpp"

namespace loopbench::harness {
namespace {

using methods::ClosureLedger;
using methods::LedgerRow;
using methods::LedgerVerdict;

/// `digits` digits; 0: the shortest that are read as the same number. Empty unless it is finite.
std::string decimal(double value, int digits = 0) {
  if (!std::isfinite(value)) return "";
  const std::string out =
      digits > 0 ? fmt::format("{:.{}g}", value, digits) : fmt::to_string(value);
  return out.find_first_not_of("-0123456789") == std::string::npos ? out + ".0" : out;
}

/// Vertex id of a graph, or stamp.
std::string keyframe_name(const Problem& problem, std::size_t keyframe) {
  if (!problem.ids.empty()) return std::to_string(problem.ids[keyframe]);
  return decimal(shown_stamp(problem.keyframes[keyframe].stamp));
}

/// "9.40 m and 179 deg from the prediction by the others; chi2 falls by 20594 without it".
std::string error_text(const LedgerRow& row) {
  std::string out;
  if (row.predicted) {
    out = fmt::format("{} m and {} deg from its prediction by the others",
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
    return "All closures are at one place, so no other place predicts them, and it cannot be shown "
           "whether the correction helps.";
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

std::string disagreement_text(const LoopsResult& result) {
  const ClosureLedger& ledger = result.ledger;
  const std::size_t all = ledger.rows.size(), agreeing = ledger.judgement->agreeing;
  std::string out;
  if (agreeing < all) {
    out = fmt::format("{} of {} {} with the {} that agree: {}. `correct` drops {}.",
                      all - agreeing,
                      counted(all, "closure"),
                      all - agreeing == 1 ? "disagrees" : "disagree",
                      agreeing,
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
  const std::string remedy =
      more > 0 ? fmt::format(" About {} at other places would decide, if they agree.",
                             counted(more, "further closure"))
               : " Closures at other places would decide.";
  if (ledger.verdict == LedgerVerdict::few) {
    return fmt::format(
        "{} cannot be checked: too few to confirm each other.{} `correct` moves "
        "nothing without --trust-loops.",
        count,
        remedy);
  }
  const std::string suspects = suspects_text(result, std::min<std::size_t>(2, ledger.rows.size()));
  if (ledger.verdict == LedgerVerdict::rival) {
    return fmt::format(
        "Two sets of closures contradict each other, and neither is clearly "
        "likelier; most suspicious: {}.{} `correct` moves nothing.",
        suspects,
        remedy);
  }
  return fmt::format(
      "Odometry and closures contradict each other, most at {}. No closure confirms "
      "another, so the cause can be the closures, the odometry (its scale) or the stated "
      "covariances (see loopbench doctor).{} `correct` moves nothing.",
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
      " {} cannot be checked by other places (the first is {}): only its place connects these "
      "keyframes; another closure between them, at another place, would allow the check.",
      counted(count, "closure"),
      first);
}

}  // namespace

double shown_stamp(double stamp) {
  const double shortened = std::strtod(fmt::format("{:.15g}", stamp).c_str(), nullptr);
  return std::abs(shortened - stamp) < 1e-9 ? shortened : stamp;
}

std::string closure_name(const Problem& problem, std::size_t closure) {
  const Edge& edge = problem.closures[closure];
  return keyframe_name(problem, edge.from) + " -> " + keyframe_name(problem, edge.to);
}

std::string plain_number(double value) {
  int decimals = 3;
  for (const double least : {1.0, 10.0, 100.0}) decimals -= value >= least ? 1 : 0;
  return fmt::format("{:.{}f}", value, decimals);
}

std::string step_name(const Problem& problem, std::size_t from) {
  return keyframe_name(problem, from) + " -> " + keyframe_name(problem, from + 1);
}

std::string verdict_text(const LoopsResult& result) {
  const ClosureLedger& ledger = result.ledger;
  if (ledger.verdict == LedgerVerdict::disagrees) {
    return disagreement_text(result) + unpredicted_text(result);
  }
  if (ledger.verdict != LedgerVerdict::agrees) return unchecked_text(result);
  const std::string all =
      ledger.rows.size() == 1
          ? "The closure agrees with the odometry. "
          : fmt::format("All {} agree. ", counted(ledger.rows.size(), "closure"));
  return all + places_text(ledger) + unpredicted_text(result);
}

const char* judgement(const LoopsResult& result, std::size_t rank) {
  switch (result.ledger.finding(result.ledger.suspects[rank])) {
    case methods::ClosureFinding::agrees:
      return "agrees";
    case methods::ClosureFinding::contradicts:
    case methods::ClosureFinding::slipped:
      return "disagrees";
    case methods::ClosureFinding::unchecked:
      break;
  }
  return "unchecked";
}

std::vector<std::pair<std::string, std::string>> ledger_row(const LoopsResult& result,
                                                            std::size_t rank,
                                                            int digits) {
  const std::size_t closure = result.ledger.suspects[rank];
  const LedgerRow& row = result.ledger.rows[closure];
  const Edge& edge = result.problem.closures[closure];
  const auto number = [&](double value) { return decimal(value, digits); };
  std::vector<std::pair<std::string, std::string>> out{
      {"from", keyframe_name(result.problem, edge.from)},
      {"to", keyframe_name(result.problem, edge.to)},
      {"place", std::to_string(row.place + 1)},
      {"loop_m", row.loop_length ? number(*row.loop_length) : ""}};
  const auto add = [&](const std::string& prefix,
                       const std::optional<methods::ClosureError>& error) {
    out.emplace_back(prefix + "_m", error ? number(error->metres) : "");
    out.emplace_back(prefix + "_deg", error ? number(error->degrees) : "");
    out.emplace_back(prefix + "_sd", error ? number(std::sqrt(error->chi2)) : "");
  };
  add("odometry", row.in_odometry);
  add("others", row.predicted);
  out.emplace_back("moves_rms_m", row.moves ? number(row.moves->rms) : "");
  out.emplace_back("moves_max_m", row.moves ? number(row.moves->max) : "");
  out.emplace_back("moves_max_at", row.moves ? keyframe_name(result.problem, row.moves->at) : "");
  out.emplace_back("chi2_drop", number(row.cost_drop));
  out.emplace_back("closure", std::to_string(closure));
  out.emplace_back("judgement", judgement(result, rank));
  out.emplace_back("others_solved", row.is_prediction_solved ? "1" : "0");
  out.emplace_back("without_solved", row.is_drop_solved ? "1" : "0");
  return out;
}

std::string csv(const LoopsResult& result, int digits) {
  std::string header, lines;
  for (std::size_t rank = 0; rank < result.ledger.suspects.size(); ++rank) {
    std::string line;
    for (const auto& [name, value] : ledger_row(result, rank, digits)) {
      if (rank == 0) header += (header.empty() ? "" : ",") + name;
      line += (name == "from" ? "" : ",") + value;
    }
    lines += line + "\n";
  }
  return header + "\n" + lines;
}

std::string stored_ledger(const Problem& problem) try {
  constexpr std::size_t kMost = 200;             // as many as the map of a report shows
  constexpr std::size_t kMostMoves = 2'000'000;  // of keyframes without a closure each
  constexpr int kDigits = 5;
  if (problem.closures.empty()) return "";
  if (problem.closures.size() > kMost) {
    return fmt::format("Not computed for more than {} closures (here {}): see loopbench loops",
                       kMost,
                       problem.closures.size());
  }
  if (problem.closures.size() * problem.keyframes.size() > kMostMoves) {
    return fmt::format("Not computed for {} closures of {} keyframes: see loopbench loops",
                       problem.closures.size(),
                       problem.keyframes.size());
  }
  const std::string why = methods::why_no_ledger(problem);
  if (!why.empty()) return why;
  LoopsResult result{"", problem, methods::closure_ledger(problem)};
  return verdict_text(result) + "\n" + csv(result, kDigits);
} catch (const std::runtime_error& error) {
  return error.what();
}

}  // namespace loopbench::harness
