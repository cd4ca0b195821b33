#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "harness/base/counted.hpp"
#include "harness/eval/loops.hpp"

namespace loopbench::harness {
namespace {

using Json = nlohmann::ordered_json;
using methods::ClosureLedger;
using methods::LedgerRow;
using methods::LedgerVerdict;

/// Robust methods, and which closures they reject.
const std::map<std::string, const char*> kRobust{
    {"pose_graph_pcm", "not in the largest set of closures that are consistent in pairs"},
    {"pose_graph_gnc_tls", "residual too large for its covariance after the correction"},
};

/// Whether a method that ran rejects the closure.
bool rejects(const std::vector<std::size_t>& rejected, std::size_t closure) {
  return std::ranges::find(rejected, closure) != rejected.end();
}

/// Vertex id of a graph, or stamp.
Json keyframe_json(const Problem& problem, std::size_t keyframe) {
  if (!problem.ids.empty()) return problem.ids[keyframe];
  return shown_stamp(problem.keyframes[keyframe].stamp);
}

/// Of LedgerVerdict, in its order.
constexpr const char* kWords[] = {
    "helps", "not_shown", "few_places", "little_covered", "contradiction", "covariances"};

/// Values of a row by the names of its columns, in their order; null: no prediction.
Json row_json(const LoopsResult& result, std::size_t closure) {
  const LedgerRow& row = result.ledger.rows[closure];
  const Edge& edge = result.problem.closures[closure];
  Json out{{"from", keyframe_json(result.problem, edge.from)},
           {"to", keyframe_json(result.problem, edge.to)},
           {"place", row.place + 1},
           {"loop_m", row.loop_length}};
  const auto add = [&](const std::string& prefix, const methods::ClosureError* error) {
    out[prefix + "_m"] = error ? Json(error->metres) : nullptr;
    out[prefix + "_deg"] = error ? Json(error->degrees) : nullptr;
    out[prefix + "_sd"] = error ? Json(std::sqrt(error->chi2)) : nullptr;
  };
  add("odometry", &row.in_odometry);
  add("others", row.predicted ? &*row.predicted : nullptr);
  out["moves_rms_m"] = row.moves_rms;
  out["moves_max_m"] = row.moves_max;
  out["moves_max_at"] = keyframe_json(result.problem, row.moves_at);
  out["chi2_drop"] = row.cost_drop;
  for (const auto& [method, rejected] : result.rejected) {
    out["rejected_by_" + method] = rejects(rejected, closure) ? 1 : 0;
  }
  return out;
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
      "{} at {}. Whether the correction helps is not shown: closures at three or more places are "
      "needed to check each by the others.",
      counted(ledger.rows.size(), "closure"),
      counted(ledger.places, "place"));
  constexpr double kFar = 10.0;  // chi2 per degree of freedom
  if (ledger.odometry_chi2 > kFar) {
    out += fmt::format(
        " The median distance of closures from the odometry is {:.3g} standard deviations: its "
        "covariances are too small, or closures are false.",
        std::sqrt(ledger.odometry_chi2));
  }
  return out;
}

std::string contradiction_text(const LoopsResult& result) {
  const ClosureLedger& ledger = result.ledger;
  const std::string first = closure_name(result, ledger.suspects.front());
  const std::string second = closure_name(result, ledger.suspects.at(1));
  if (ledger.places < methods::kMinPlaces) {
    return fmt::format(
        "Odometry and closures disagree (chi2 up to {:.3g} per degree of freedom, most at {} and "
        "{}). With closures at fewer than three places it cannot be known whether these, the "
        "odometry (its scale) or the stated covariances are wrong, see loopbench doctor. Do not "
        "use the correction.",
        ledger.largest_chi2,
        first,
        second);
  }
  const std::string out = fmt::format(
      "{}losure {}, or else {}, contradicts the others (chi2 up to {:.3g} per degree of freedom). "
      "Do not use {}.",
      result.is_kept ? "Of the closures kept, c" : "C",
      first,
      second,
      ledger.largest_chi2,
      result.is_kept ? "this correction" : "the correction by all closures; try pose_graph_pcm");
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

std::string closure_name(const LoopsResult& result, std::size_t closure) {
  const Edge& edge = result.problem.closures[closure];
  return keyframe_json(result.problem, edge.from).dump() + " -> " +
         keyframe_json(result.problem, edge.to).dump();
}

std::string verdict_text(const LoopsResult& result) {
  const ClosureLedger& ledger = result.ledger;
  switch (ledger.verdict) {
    case LedgerVerdict::helps:
      return places_text(ledger) + " The correction probably helps; by how much is not known.";
    case LedgerVerdict::not_shown:
      return places_text(ledger) +
             " Whether the correction helps is not shown: the others do not predict a place "
             "clearly better than the odometry does.";
    case LedgerVerdict::little_covered:
      return places_text(ledger) +
             " Whether the correction helps is not shown: at least 30 % would be needed, from "
             "closures at other places.";
    case LedgerVerdict::few_places:
      return few_places_text(ledger);
    case LedgerVerdict::contradiction:
    case LedgerVerdict::covariances:
      return contradiction_text(result);
  }
  return "";
}

std::string text(const LoopsResult& result, std::size_t rows) {
  const ClosureLedger& ledger = result.ledger;
  std::size_t width = 7;
  const std::size_t shown = std::min(rows, ledger.suspects.size());
  for (std::size_t i = 0; i < shown; ++i) {
    width = std::max(width, closure_name(result, ledger.suspects[i]).size());
  }
  std::string out = fmt::format("{}: {}, {}, {}\n\n{}\n\n",
                                result.estimate,
                                counted(result.problem.keyframes.size(), "keyframe"),
                                counted(ledger.rows.size(), "closure"),
                                counted(ledger.places, "place"),
                                verdict_text(result));
  const std::string space(width - 7, ' ');
  const std::string units = "       [m]  [deg]   [sd]";
  out += space +
         "                  loop  against odometry        against other places       moves"
         "     chi2\nclosure" +
         space + " place      [m]" + units + units + "   rms [m]     drop" +
         (result.rejected.empty() ? "" : "  rejected by") + "\n";
  for (std::size_t i = 0; i < shown; ++i) {
    const LedgerRow& row = ledger.rows[ledger.suspects[i]];
    out += fmt::format("{:<{}} {:>5} {:>8.1f}",
                       closure_name(result, ledger.suspects[i]),
                       width,
                       row.place + 1,
                       row.loop_length);
    const auto add = [&](const methods::ClosureError& e) {
      out += fmt::format("  {:>8.3f} {:>6.2f} {:>6.3g}", e.metres, e.degrees, std::sqrt(e.chi2));
    };
    add(row.in_odometry);
    if (row.predicted) add(*row.predicted);
    if (!row.predicted) out += fmt::format("  {:>8} {:>6} {:>6}", "-", "-", "-");
    out += fmt::format("  {:>8.3f} {:>8.3g}", row.moves_rms, row.cost_drop);
    for (const auto& [method, rejected] : result.rejected) {
      if (rejects(rejected, ledger.suspects[i])) out += "  " + method;
    }
    out += "\n";
  }
  if (shown < ledger.suspects.size()) {
    out += fmt::format("{} more: --csv FILE\n", ledger.suspects.size() - shown);
  }
  out += "\n";
  for (const auto& [method, rejected] : result.rejected) {
    if (rejected.empty()) continue;
    out += fmt::format(
        "{} rejects {}: {}.\n", method, counted(rejected.size(), "closure"), kRobust.at(method));
  }
  out +=
      "place: closures that join the same two stretches of the path; [sd]: error in standard "
      "deviations; moves: change of the trajectory without the closure; chi2 drop: decrease of the "
      "cost without it\n"
      "Errors that all closures share (lever arm, bias) are not visible here.\n";
  return out;
}

std::string csv(const LoopsResult& result) {
  std::string out;
  for (const std::size_t closure : result.ledger.suspects) {
    std::string line;
    std::string header;
    const Json row = row_json(result, closure);
    for (const auto& [name, value] : row.items()) {
      const std::string comma = header.empty() ? "" : ",";
      header += comma + name;
      line += comma;
      if (!value.is_null()) line += value.dump();
    }
    if (out.empty()) out = header + "\n";
    out += line + "\n";
  }
  return out;
}

std::string json(const LoopsResult& result) {
  const ClosureLedger& ledger = result.ledger;
  Json out{{"estimate", result.estimate},
           {"verdict", kWords[static_cast<std::size_t>(ledger.verdict)]},
           {"sentence", verdict_text(result)},
           {"places", ledger.places},
           {"better_places", ledger.better_places},
           {"ratio", ledger.places > 1 ? Json(ledger.ratio) : nullptr},
           {"covered", ledger.covered},
           {"closures", Json::array()}};
  for (const std::size_t closure : ledger.suspects) {
    out["closures"].push_back(row_json(result, closure));
  }
  return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace loopbench::harness
