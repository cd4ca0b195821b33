#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/core/fields.hpp"
#include "harness/commands/loops/loop_json.hpp"
#include "harness/commands/loops/loops.hpp"
#include "harness/sweep/text/counted.hpp"

namespace loopbench::harness {
namespace {

using Json = nlohmann::ordered_json;
using methods::ClosureLedger;
using methods::LedgerRow;

constexpr std::size_t kWidestName = 13;  // name of a closure in a row of 80 columns

struct LedgerJson {
  Json operator()(std::monostate) const { return nullptr; }
  Json operator()(LedgerStamp at) const { return at.stamp; }
  template <class Value>
  Json operator()(const Value& value) const {
    return value;
  }
};

Json row_json(const LoopsResult& result, std::size_t rank) {
  Json out;
  for (const auto& [name, value] : ledger_row(result, rank)) {
    out[name] = std::visit(LedgerJson(), value);
  }
  return out;
}

/// null without anchors.
Json anchors_json(const LoopsResult& result) {
  const auto& found = result.ledger.anchors;
  if (!found) return nullptr;
  Json dropped = Json::array();
  for (std::size_t i = 0; i < found->anchors.size(); ++i) {
    const auto& each = found->anchors[i];
    if (found->is_decided && each.agrees) continue;
    dropped.push_back({{"at", keyframe_json(result.problem, result.problem.anchors[i].keyframe)},
                       {"metres", each.metres},
                       {"log_odds", each.log_odds}});
  }
  return {{"used", found->anchors.size() - dropped.size()},
          {"decided", found->is_decided},
          {"factor", found->factor},
          {"dropped", dropped}};
}

Json next_json(const LoopsResult& result, const methods::NextClosures& next) {
  Json closures = Json::array();
  for (const methods::NextClosure& each : next.found) {
    closures.push_back({{"from", keyframe_json(result.problem, each.from)},
                        {"to", keyframe_json(result.problem, each.to)},
                        {"metres", each.metres},
                        {"deviation", each.deviation}});
  }
  return {{"deviation", next.deviation}, {"closures", closures}};
}

/// The names are wider than a column: they have a line of their own.
bool has_wide_names(const LoopsResult& result, std::size_t shown) {
  return std::any_of(
      result.ledger.suspects.begin(),
      result.ledger.suspects.begin() + static_cast<std::ptrdiff_t>(shown),
      [&](std::size_t k) { return closure_name(result.problem, k).size() > kWidestName; });
}

/// A number of 9 columns, marked if it is linearised.
std::string marked(double value, bool is_solved) {
  return fmt::format("{:>9}", (is_solved ? "" : "~") + plain_number(value));
}

std::string row_text(const LoopsResult& result, std::size_t rank, bool is_wide) {
  const std::size_t k = result.ledger.suspects[rank];
  const LedgerRow& row = result.ledger.rows[k];
  const std::string name = closure_name(result.problem, k);
  std::string out =
      is_wide ? name + "\n" + std::string(kWidestName, ' ') : fmt::format("{:<13}", name);
  out += fmt::format(" {:<9}", judgement(result, rank));
  if (row.in_odometry) {
    out += fmt::format(" {:>7} {:>5}",
                       plain_number(row.in_odometry->metres),
                       plain_number(row.in_odometry->degrees));
  } else {
    out += fmt::format(" {:>7} {:>5}", "-", "-");
  }
  if (row.predicted) {
    out += marked(row.predicted->metres, row.is_prediction_solved);
    out += fmt::format(" {:>5} {:>5}",
                       plain_number(row.predicted->degrees),
                       plain_number(std::sqrt(row.predicted->chi2)));
  } else {
    out += fmt::format("{:>9} {:>5} {:>5}", "-", "-", "-");
  }
  out += row.moves ? marked(row.moves->rms, row.is_drop_solved) : fmt::format("{:>9}", "-");
  return out + marked(row.cost_drop, row.is_drop_solved) + "\n";
}

std::string next_text(const LoopsResult& result, const methods::NextClosures& next) {
  if (next.found.empty())
    return "No further closure is possible between keyframes that are near.\n";
  std::string out = fmt::format(
      "Standard deviation of the positions: {} m (rms, as stated). With one more closure:\n",
      plain_number(next.deviation));
  for (const methods::NextClosure& each : next.found) {
    out += fmt::format("{} -> {}: {} m ({} m apart)\n",
                       keyframe_json(result.problem, each.from).dump(),
                       keyframe_json(result.problem, each.to).dump(),
                       plain_number(each.deviation),
                       plain_number(each.metres));
  }
  return out + "\n";
}

}  // namespace

std::string counts_text(const LoopsResult& result) {
  const ClosureLedger& ledger = result.ledger;
  const std::string keyframes = counted(result.problem.keyframes.size(), "keyframe");
  if (ledger.rows.empty()) {
    return keyframes + ", " + counted(result.problem.anchors.size(), "anchor");
  }
  return keyframes + ", " + counted(ledger.rows.size(), "closure") + ", " +
         counted(ledger.places, "place");
}

std::string text(const LoopsResult& result,
                 std::size_t rows,
                 const std::optional<methods::NextClosures>& next) {
  const ClosureLedger& ledger = result.ledger;
  const std::size_t shown = std::min(rows, ledger.suspects.size());
  const bool is_wide = has_wide_names(result, shown);
  std::string out =
      fmt::format("{}: {}\n\n{}\n", result.estimate, counts_text(result), verdict_text(result));
  if (ledger.rows.empty()) return out + (next ? "\n" + next_text(result, *next) : "");
  out +=
      "\n"
      "                            odometry          other places        without it\n"
      "closure       judgement     [m] [deg]      [m] [deg]  [sd]   moves     chi2\n";
  for (std::size_t rank = 0; rank < shown; ++rank) out += row_text(result, rank, is_wide);
  if (shown < ledger.suspects.size()) {
    out += fmt::format("{} more: --csv FILE\n", ledger.suspects.size() - shown);
  }
  out += "\n";
  if (next) out += next_text(result, *next);
  out +=
      "odometry: distance and angle between the closure and the odometry between its keyframes\n"
      "other places: distance and angle between the closure and the solution with all closures "
      "that agree, except those of its own place (a place is a group of closures whose two ends "
      "are within 20 keyframes of the ends of its first closure); [sd]: the same in stated "
      "standard deviations\n"
      "without it: change of the positions [m] (rms) and decrease of chi2 if this closure is left "
      "out of the solution with all closures\n"
      "~: first-order approximation; -: not available\n"
      "Errors that all closures share (lever arm, bias) do not appear here.\n";
  return out;
}

std::string json(const LoopsResult& result, const std::optional<methods::NextClosures>& next) {
  const ClosureLedger& ledger = result.ledger;
  Json out{{"estimate", result.estimate},
           {"verdict", to_text(ledger.verdict)},
           {"helps", ledger.helps},
           {"sentence", verdict_text(result)},
           {"places", ledger.places},
           {"better_places", ledger.better_places},
           {"ratio", ledger.places > 1 ? Json(ledger.ratio) : Json()},
           {"covered", ledger.covered},
           {"steps",
            ledger.judgement ? steps_json(result.problem, ledger.judgement->steps) : Json::array()},
           {"anchors", anchors_json(result)},
           {"closures", Json::array()}};
  for (std::size_t rank = 0; rank < ledger.suspects.size(); ++rank) {
    out["closures"].push_back(row_json(result, rank));
  }
  if (next) out["next"] = next_json(result, *next);
  return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace loopbench::harness
