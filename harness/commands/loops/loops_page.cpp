#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <utility>

#include "harness/answers/report/map_svg.hpp"
#include "harness/answers/report/page_template.hpp"
#include "harness/answers/report/sections.hpp"
#include "harness/commands/loops/loops.hpp"
#include "harness/sweep/text/hash.hpp"
#include "methods/correctors/consensus.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostRowsOfPage = 500;

std::string linearised(double value, bool is_solved) {
  return (is_solved ? "" : "~") + plain_number(value);
}

Table closures_table(const LoopsResult& result) {
  const std::size_t all = result.ledger.suspects.size();
  Table out{.title = "Closures, the most suspicious first",
            .headings = {"closure",
                         "judgement",
                         "place",
                         "odometry [m]",
                         "[deg]",
                         "others [m]",
                         "[deg]",
                         "[sd]",
                         "moves rms [m]",
                         "chi2 drop"},
            .lines = {},
            .notes = {}};
  for (std::size_t rank = 0; rank < std::min(all, kMostRowsOfPage); ++rank) {
    const std::size_t k = result.ledger.suspects[rank];
    const methods::LedgerRow& row = result.ledger.rows[k];
    const auto& odometry = row.in_odometry;
    const auto& others = row.predicted;
    out.lines.push_back({closure_name(result.problem, k),
                         judgement(result, rank),
                         std::to_string(row.place + 1),
                         odometry ? plain_number(odometry->metres) : "-",
                         odometry ? plain_number(odometry->degrees) : "-",
                         others ? linearised(others->metres, row.is_prediction_solved) : "-",
                         others ? plain_number(others->degrees) : "-",
                         others ? plain_number(std::sqrt(others->chi2)) : "-",
                         row.moves ? linearised(row.moves->rms, row.is_drop_solved) : "-",
                         linearised(row.cost_drop, row.is_drop_solved)});
  }
  if (all > kMostRowsOfPage) {
    out.notes.push_back(fmt::format("{} more: --csv FILE", all - kMostRowsOfPage));
  }
  out.notes.emplace_back(
      "odometry: distance and angle between the closure and the odometry between its keyframes; "
      "others: the same to the solution with the closures of other places that agree; [sd]: stated "
      "standard deviations; moves: change of the positions without the closure; chi2 drop: "
      "decrease "
      "of the cost without it; ~: computed to first order");
  return out;
}

Table steps_table(const LoopsResult& result) {
  Table out{.title = "Steps of the odometry that are wrong",
            .headings = {"step", "error [m]", "[deg]", "times its deviation"},
            .lines = {},
            .notes = {}};
  for (const methods::FreedStep& step : result.ledger.judgement->steps) {
    out.lines.push_back(
        {step_name(result.problem, step.from),
         plain_number(step.metres),
         plain_number(step.degrees),
         std::isinf(step.inflation) ? "unknown motion" : fmt::format("{:.0f}", step.inflation)});
  }
  return out;
}

Table anchors_table(const LoopsResult& result) {
  Table out{.title = "Anchors that disagree",
            .headings = {"keyframe", "from the prediction by the others [m]"},
            .lines = {},
            .notes = {}};
  const auto& found = *result.ledger.anchors;
  for (std::size_t i = 0; i < found.anchors.size(); ++i) {
    if (found.is_decided && found.anchors[i].agrees) continue;
    out.lines.push_back({result.problem.name_of(result.problem.anchors[i].keyframe),
                         plain_number(found.anchors[i].metres)});
  }
  return out;
}

std::string page_section(const Table& table) {
  return table.lines.empty() ? "" : "<section>" + html_table(table) + "</section>\n";
}

/// The keyframes as `correct` moves them; its reason if it moves nothing.
std::pair<Trajectory, std::string> corrected_keyframes(const LoopsResult& result) {
  const auto& found = result.ledger.judgement;
  const methods::Consensus method(
      {}, found ? std::make_shared<methods::ClosureJudgement>(*found) : nullptr, false);
  if (std::string why = method.why_declined(result.problem); !why.empty()) return {{}, why};
  const bool has_anchors = result.ledger.anchors && result.ledger.anchors->is_decided;
  if (!has_anchors && !found) return {{}, "which anchors are right is not decided"};
  if (!has_anchors && !found->is_decided()) return {{}, "which closures are right is not decided"};
  try {
    methods::Report unused;
    return {method.correct(result.problem, unused), ""};
  } catch (const std::runtime_error& error) {
    return {{}, error.what()};
  }
}

std::string maps(const LoopsResult& result) {
  auto [corrected, why] = corrected_keyframes(result);
  const auto drawn = [&](const Trajectory& poses, bool with_anchors, const std::string& title) {
    FigureData map = loops_figure(result, poses, with_anchors);
    map.title = title;
    thin(map.curves.front());
    return map_figure(map);
  };
  const std::string before = drawn(result.problem.keyframes, false, "Before correction");
  if (why.empty()) return before + drawn(corrected, true, "After correction");
  return before +
         "<figure><figcaption>After correction</figcaption><p>Not drawn: " + html_text(why) +
         ".</p></figure>";
}

}  // namespace

std::string loops_page(const LoopsResult& result) {
  std::string tables;
  if (result.ledger.judgement) tables += page_section(steps_table(result));
  if (result.ledger.anchors) tables += page_section(anchors_table(result));
  tables += page_section(closures_table(result));
  const std::string verdict = verdict_text(result);
  // No text of the input can contain the nonce, a hash of all of them.
  const std::string title = std::filesystem::path(result.estimate).filename().string();
  return filled(asset_text("page/loops.html"),
                {{"title", html_text(title)},
                 {"nonce", hex(hash_of(title + verdict + tables))},
                 {"style", "\n" + asset_text("page/report.css") + "\n"},
                 {"counts", html_text(counts_text(result))},
                 {"verdict", html_text(verdict)},
                 {"maps", maps(result)},
                 {"tables", tables}});
}

}  // namespace loopbench::harness
