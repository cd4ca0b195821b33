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

std::string places_text(const ClosureLedger& ledger) {
  return fmt::format(
      "{} places, each predicted from the others: typically {:.2f} of the odometry's error ({} of "
      "{} better); {:.0f} % of the path lies in loops of two places.",
      ledger.places,
      ledger.ratio,
      ledger.better_places,
      ledger.places,
      100.0 * ledger.covered);
}

std::string few_places_text(const ClosureLedger& ledger) {
  std::string out = fmt::format(
      "{} at {}. Whether the correction helps cannot be shown: closures at three or more places "
      "are needed to check each by the others.",
      counted(ledger.rows.size(), "closure"),
      counted(ledger.places, "place"));
  constexpr double kFar = 10.0;  // chi2 per degree of freedom
  if (ledger.odometry_chi2 > kFar) {
    out += fmt::format(
        " The median distance of closures from the odometry is {} standard deviations: its "
        "covariances are too small, or closures are false.",
        plain_number(std::sqrt(ledger.odometry_chi2)));
  }
  return out;
}

std::string contradiction_text(const LoopsResult& result) {
  const ClosureLedger& ledger = result.ledger;
  const LedgerRow& first = ledger.rows[ledger.suspects.front()];
  const std::string suspects =
      fmt::format("{} ({} standard deviations from the odometry; chi2 is {} lower without it)",
                  closure_name(result.problem, ledger.suspects.front()),
                  plain_number(std::sqrt(first.in_odometry.chi2)),
                  plain_number(first.cost_drop)) +
      ", then " + closure_name(result.problem, ledger.suspects.at(1));
  if (ledger.places < methods::kMinPlaces) {
    return "Odometry and closures disagree, most at " + suspects +
           ". With closures at fewer than three places it cannot be known whether these, the "
           "odometry (its scale) or the stated covariances are wrong, see loopbench doctor. Do not "
           "use the correction.";
  }
  const std::string out = fmt::format(
      "{} contradict each other: most suspicious is {}. Do not {}.",
      result.is_kept ? "The closures that were kept" : "Closures",
      suspects,
      result.is_kept ? "use this correction" : "correct with all closures; try pose_graph_pcm");
  if (ledger.verdict == LedgerVerdict::contradiction) return out;
  return out +
         " Most closures contradict the odometry, too: either the stated covariances are too small "
         "or most closures are false (see loopbench doctor).";
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

std::string verdict_text(const LoopsResult& result) {
  const ClosureLedger& ledger = result.ledger;
  if (methods::is_contradicted(ledger.verdict)) return contradiction_text(result);
  if (ledger.verdict == LedgerVerdict::few_places) return few_places_text(ledger);
  const std::string places = places_text(ledger);
  if (ledger.verdict == LedgerVerdict::helps) {
    return places + " The correction probably helps; by how much is not known.";
  }
  return places + " Whether the correction helps cannot be shown: " +
         (ledger.verdict == LedgerVerdict::little_covered
              ? "at least 30 % would be needed, from closures at other places."
              : "the others do not predict a place clearly better than the odometry does.");
}

const char* judgement(const LoopsResult& result, std::size_t rank) {
  constexpr double kConfirmed = 3.0, kContradiction = 10.0;  // chi2 per degree of freedom
  const LedgerRow& row = result.ledger.rows[result.ledger.suspects[rank]];
  const double without = row.cost_drop / (result.problem.planar ? 3.0 : 6.0);
  const double chi2 = std::max(row.predicted ? row.predicted->chi2 : 0.0, without);
  // A false closure makes true ones contradict the others, but not the odometry.
  const bool is_far = std::min(chi2, row.in_odometry.chi2) > kContradiction;
  if (methods::is_contradicted(result.ledger.verdict) && (rank < 2 || is_far)) return "suspicious";
  return row.predicted && chi2 <= kConfirmed ? "confirmed" : "doubtful";
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
      {"loop_m", number(row.loop_length)}};
  const auto add = [&](const std::string& prefix,
                       const std::optional<methods::ClosureError>& error) {
    out.emplace_back(prefix + "_m", error ? number(error->metres) : "");
    out.emplace_back(prefix + "_deg", error ? number(error->degrees) : "");
    out.emplace_back(prefix + "_sd", error ? number(std::sqrt(error->chi2)) : "");
  };
  add("odometry", row.in_odometry);
  add("others", row.predicted);
  out.emplace_back("moves_rms_m", number(row.moves_rms));
  out.emplace_back("moves_max_m", number(row.moves_max));
  out.emplace_back("moves_max_at", keyframe_name(result.problem, row.moves_at));
  out.emplace_back("chi2_drop", number(row.cost_drop));
  out.emplace_back("closure", std::to_string(closure));
  out.emplace_back("judgement", judgement(result, rank));
  for (const auto& [method, rejected] : result.rejected) {
    const bool is_rejected = std::ranges::find(rejected, closure) != rejected.end();
    out.emplace_back("rejected_by_" + method, is_rejected ? "1" : "0");
  }
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
