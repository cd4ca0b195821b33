#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "harness/commands/loops/loops.hpp"
#include "harness/sweep/text/counted.hpp"

namespace loopbench::harness {
namespace {

using Json = nlohmann::ordered_json;
using methods::ClosureLedger;
using methods::LedgerRow;

/// Robust methods, and which closures they reject.
const std::map<std::string, const char*> kRobust{
    {"pose_graph_pcm", "not in the largest set of closures that are consistent in pairs"},
    {"pose_graph_gnc_tls", "residual too large for its covariance after the correction"},
};

/// Of LedgerVerdict, in its order.
constexpr const char* kWords[] = {
    "helps", "not_shown", "few_places", "little_covered", "contradiction", "covariances"};

/// Numbers, words, or null without a prediction.
Json row_json(const LoopsResult& result, std::size_t rank) {
  Json out;
  for (const auto& [name, value] : ledger_row(result, rank)) {
    const Json number = Json::parse(value, nullptr, false);
    if (value.empty()) {
      out[name] = Json();
    } else {
      out[name] = number.is_discarded() ? Json(value) : number;
    }
  }
  return out;
}

}  // namespace

std::string text(const LoopsResult& result, std::size_t rows) {
  const ClosureLedger& ledger = result.ledger;
  std::size_t width = 7;
  const std::size_t shown = std::min(rows, ledger.suspects.size());
  for (std::size_t i = 0; i < shown; ++i) {
    width = std::max(width, closure_name(result.problem, ledger.suspects[i]).size());
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
                       closure_name(result.problem, ledger.suspects[i]),
                       width,
                       row.place + 1,
                       row.loop_length);
    const auto add = [&](const methods::ClosureError& e) {
      out += fmt::format(
          "  {:>8.3f} {:>6.2f} {:>6}", e.metres, e.degrees, plain_number(std::sqrt(e.chi2)));
    };
    add(row.in_odometry);
    if (row.predicted) add(*row.predicted);
    if (!row.predicted) out += fmt::format("  {:>8} {:>6} {:>6}", "-", "-", "-");
    out += fmt::format("  {:>8.3f} {:>8}", row.moves_rms, plain_number(row.cost_drop));
    for (const auto& [method, rejected] : result.rejected) {
      if (std::ranges::count(rejected, ledger.suspects[i]) > 0) out += "  " + method;
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
  for (std::size_t rank = 0; rank < ledger.suspects.size(); ++rank) {
    out["closures"].push_back(row_json(result, rank));
  }
  return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace loopbench::harness
