#include "harness/sweep/model/loops.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <optional>
#include <stdexcept>

namespace loopbench::harness {
namespace {

using methods::LedgerRow;

/// `digits` digits; 0: the shortest that are read as the same number.
std::string decimal(double value, int digits = 0) {
  const std::string out =
      digits > 0 ? fmt::format("{:.{}g}", value, digits) : fmt::to_string(value);
  return out.find_first_not_of("-0123456789") == std::string::npos ? out + ".0" : out;
}

/// Vertex id of a graph, or stamp.
std::string keyframe_name(const Problem& problem, std::size_t keyframe) {
  if (!problem.ids.empty()) return id_text(problem.ids[keyframe]);
  return decimal(shown_stamp(problem.keyframes[keyframe].stamp));
}

/// The same as data: ids and stamps are numbers.
LedgerValue keyframe_value(const Problem& problem, std::size_t keyframe) {
  if (problem.ids.empty()) return LedgerStamp{shown_stamp(problem.keyframes[keyframe].stamp)};
  const std::int64_t id = problem.ids[keyframe];
  return is_symbol(id) ? LedgerValue(id_text(id)) : LedgerValue(id);
}

LedgerValue finite(double value) {
  return std::isfinite(value) ? LedgerValue(value) : LedgerValue();
}

/// In CSV.
struct LedgerText {
  int digits = 0;

  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(const std::string& name) const { return name; }
  std::string operator()(std::int64_t number) const { return std::to_string(number); }
  std::string operator()(LedgerStamp at) const { return decimal(at.stamp); }
  std::string operator()(double number) const { return decimal(number, digits); }
};

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

std::vector<std::pair<std::string, LedgerValue>> ledger_row(const LoopsResult& result,
                                                            std::size_t rank) {
  const std::size_t closure = result.ledger.suspects[rank];
  const LedgerRow& row = result.ledger.rows[closure];
  const Edge& edge = result.problem.closures[closure];
  const LedgerValue none;
  std::vector<std::pair<std::string, LedgerValue>> out{
      {"from", keyframe_value(result.problem, edge.from)},
      {"to", keyframe_value(result.problem, edge.to)},
      {"place", static_cast<std::int64_t>(row.place) + 1},
      {"loop_m", row.loop_length ? finite(*row.loop_length) : none}};
  const auto add = [&](const std::string& prefix,
                       const std::optional<methods::ClosureError>& error) {
    out.emplace_back(prefix + "_m", error ? finite(error->metres) : none);
    out.emplace_back(prefix + "_deg", error ? finite(error->degrees) : none);
    out.emplace_back(prefix + "_sd", error ? finite(std::sqrt(error->chi2)) : none);
  };
  add("odometry", row.in_odometry);
  add("others", row.predicted);
  out.emplace_back("moves_rms_m", row.moves ? finite(row.moves->rms) : none);
  out.emplace_back("moves_max_m", row.moves ? finite(row.moves->max) : none);
  out.emplace_back("moves_max_at",
                   row.moves ? keyframe_value(result.problem, row.moves->at) : none);
  out.emplace_back("chi2_drop", finite(row.cost_drop));
  out.emplace_back("closure", static_cast<std::int64_t>(closure));
  out.emplace_back("judgement", judgement(result, rank));
  out.emplace_back("others_solved", std::int64_t{row.is_prediction_solved});
  out.emplace_back("without_solved", std::int64_t{row.is_drop_solved});
  return out;
}

std::string csv(const LoopsResult& result, int digits) {
  std::string header, lines;
  for (std::size_t rank = 0; rank < result.ledger.suspects.size(); ++rank) {
    std::string line;
    for (const auto& [name, value] : ledger_row(result, rank)) {
      if (rank == 0) header += (header.empty() ? "" : ",") + name;
      line += (name == "from" ? "" : ",") + std::visit(LedgerText{digits}, value);
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
