#include "harness/eval/loops.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "datasets/core/error.hpp"
#include "harness/base/counted.hpp"

namespace loopbench::harness {
namespace {

using methods::ClosureLedger;
using methods::LedgerRow;
using methods::LedgerVerdict;

const char* word(LedgerVerdict verdict) {
  switch (verdict) {
    case LedgerVerdict::helps:
      return "helps";
    case LedgerVerdict::not_shown:
      return "not_shown";
    case LedgerVerdict::few_places:
      return "few_places";
    case LedgerVerdict::little_covered:
      return "little_covered";
    case LedgerVerdict::contradiction:
      return "contradiction";
    case LedgerVerdict::covariances:
      return "covariances";
  }
  return "";
}

/// Values of a row by the names of its columns, in their order; null: no prediction.
nlohmann::ordered_json row_json(const LoopsResult& result, std::size_t closure) {
  const LedgerRow& row = result.ledger.rows[closure];
  const Edge& edge = result.problem.closures[closure];
  nlohmann::ordered_json out{{"from", result.names[edge.from]},
                             {"to", result.names[edge.to]},
                             {"place", row.place + 1},
                             {"loop_m", row.loop_length}};
  const auto add = [&](const std::string& prefix, const methods::ClosureError* error) {
    out[prefix + "_m"] = error ? nlohmann::ordered_json(error->metres) : nullptr;
    out[prefix + "_deg"] = error ? nlohmann::ordered_json(error->degrees) : nullptr;
    out[prefix + "_sd"] = error ? nlohmann::ordered_json(std::sqrt(error->chi2)) : nullptr;
  };
  add("odometry", &row.in_odometry);
  add("others", row.predicted ? &*row.predicted : nullptr);
  out["moves_rms_m"] = row.moves_rms;
  out["moves_max_m"] = row.moves_max;
  out["moves_max_at"] = result.names[row.moves_at];
  out["chi2_drop"] = row.cost_drop;
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
  const std::string found = ledger.rows.size() == 1 ? "There is one closure"
                                                    : fmt::format("The {} closures lie at {}",
                                                                  ledger.rows.size(),
                                                                  counted(ledger.places, "place"));
  return found +
         ". Whether the correction helps is not shown: closures at three or more places are needed "
         "to check each by the others.";
}

std::string contradiction_text(const LoopsResult& result) {
  const ClosureLedger& ledger = result.ledger;
  const std::string first = closure_name(result, ledger.suspects.front());
  const std::string second = closure_name(result, ledger.suspects.at(1));
  if (ledger.rows.size() == 2) {
    return fmt::format(
        "Closures {} and {} contradict each other (chi2 {:.3g} per degree of freedom): at least "
        "one "
        "is false, and which one cannot be known from two. Do not use the correction.",
        first,
        second,
        ledger.largest_chi2);
  }
  const std::string out = fmt::format(
      "Closure {} contradicts the others (chi2 up to {:.3g} per degree of freedom), or else {}. Do "
      "not use the correction by all closures; try pose_graph_pcm.",
      first,
      ledger.largest_chi2,
      second);
  if (ledger.verdict == LedgerVerdict::contradiction) return out;
  return out +
         " Most closures contradict the odometry, too: either the stated covariances are too small "
         "or most closures are false (see loopbench doctor).";
}

}  // namespace

LoopsResult loops(Problem problem, std::string estimate, std::vector<std::string> names) {
  if (const std::string why = methods::why_no_ledger(problem); !why.empty()) {
    throw InputError(estimate + ": " + why);
  }
  LoopsResult out{std::move(estimate), std::move(problem), std::move(names), {}};
  out.ledger = methods::closure_ledger(out.problem);
  return out;
}

std::string closure_name(const LoopsResult& result, std::size_t closure) {
  const Edge& edge = result.problem.closures[closure];
  return result.names[edge.to] + " -> " + result.names[edge.from];
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
  out += fmt::format("{:<{}} {:>5} {:>8}  {:<22}  {:<22}  {:>8} {:>8}\n{:<{}} {:>5} {:>8}",
                     "",
                     width,
                     "",
                     "loop",
                     "against odometry",
                     "against other places",
                     "moves",
                     "chi2",
                     "closure",
                     width,
                     "place",
                     "[m]");
  for (int i = 0; i < 2; ++i) out += fmt::format("  {:>8} {:>6} {:>6}", "[m]", "[deg]", "[sd]");
  out += fmt::format("  {:>8} {:>8}\n", "rms [m]", "drop");
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
    out += fmt::format("  {:>8.3f} {:>8.3g}\n", row.moves_rms, row.cost_drop);
  }
  if (shown < ledger.suspects.size()) {
    out += fmt::format("{} more: --csv FILE\n", ledger.suspects.size() - shown);
  }
  out += "\nErrors that all closures share (lever arm, bias) are not visible here.\n";
  return out;
}

std::string csv(const LoopsResult& result) {
  std::string out;
  for (const std::size_t closure : result.ledger.suspects) {
    std::string line;
    std::string header;
    const nlohmann::ordered_json row = row_json(result, closure);
    for (const auto& [name, value] : row.items()) {
      const std::string comma = header.empty() ? "" : ",";
      header += comma + name;
      line += comma;
      if (value.is_string()) line += value.get<std::string>();
      if (value.is_number()) line += value.dump();
    }
    if (out.empty()) out = header + "\n";
    out += line + "\n";
  }
  return out;
}

std::string json(const LoopsResult& result) {
  const ClosureLedger& ledger = result.ledger;
  nlohmann::ordered_json out{
      {"estimate", result.estimate},
      {"verdict", word(ledger.verdict)},
      {"sentence", verdict_text(result)},
      {"places", ledger.places},
      {"better_places", ledger.better_places},
      {"ratio",
       ledger.places > 1 ? nlohmann::ordered_json(ledger.ratio) : nlohmann::ordered_json(nullptr)},
      {"covered", ledger.covered},
      {"closures", nlohmann::ordered_json::array()}};
  for (const std::size_t closure : ledger.suspects) {
    out["closures"].push_back(row_json(result, closure));
  }
  return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

FigureData loops_figure(const LoopsResult& result) {
  FigureData out{result.estimate, "", {{.name = "keyframes"}}, {}};
  add_poses(out.curves[0], result.problem.keyframes, 0.0);
  thin(out.curves[0]);
  struct Kind {
    const char* name;
    std::size_t style;
    double most_chi2;
  };
  double from = 0.0;
  for (const Kind& kind : {Kind{"closures that the others confirm", 2, 3.0},
                           Kind{"doubtful closures", 4, 10.0},
                           Kind{"closures that contradict the others", 3, INFINITY}}) {
    DrawnCurve curve{.name = kind.name, .style = kind.style, .dash = 1};
    for (std::size_t k = 0; k < result.ledger.rows.size(); ++k) {
      const auto& predicted = result.ledger.rows[k].predicted;
      const double chi2 = predicted ? predicted->chi2 : 0.5 * (3.0 + 10.0);
      if (!(chi2 > from || from == 0.0) || chi2 > kind.most_chi2) continue;
      const Edge& edge = result.problem.closures[k];
      const auto position = [&](std::size_t i) -> Vector3 {
        return result.problem.keyframes[i].world_from_body.translation;
      };
      add_position(curve, position(edge.from));
      add_position(curve, position(edge.to));
      add_position(curve, Vector3::Constant(NAN));  // a gap between two closures
    }
    from = kind.most_chi2;
    if (!curve.columns.empty()) out.curves.push_back(std::move(curve));
  }
  return out;
}

}  // namespace loopbench::harness
