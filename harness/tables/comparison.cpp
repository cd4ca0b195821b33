#include "harness/tables/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "harness/tables/text.hpp"

namespace loopbench::harness {
namespace {

std::string title(const Comparison& c) {
  std::string out;
  const std::string relation = c.kind.relation == "translation" ? "" : c.kind.relation;
  const std::string axis = c.kind.axis == "3d" ? "" : c.kind.axis;
  for (const std::string& word : {metric_label(c.kind).text(), relation, axis, c.options.value}) {
    if (!word.empty()) out += (out.empty() ? "" : " ") + word;
  }
  return out + ", " + c.kind.times + ", " + c.kind.protocol;
}

std::string p_text(double p) { return p < 0.0001 ? "< 0.0001" : fmt::format("{:.4f}", p); }

const char* over_name(Over over) {
  return over == Over::groups ? "groups" : over == Over::runs ? "runs" : "sequences";
}

std::string rank_text(const MethodVerdict& m) {
  return m.lowest_rank == m.highest_rank ? fmt::format("{}", m.lowest_rank)
                                         : fmt::format("{}-{}", m.lowest_rank, m.highest_rank);
}

/// With the number of runs if not all runs are included.
std::string median_text(const Comparison& c, const MethodVerdict& m, int digits) {
  if (m.runs == 0) return "-";
  const std::string over = m.fails > 0 ? fmt::format(" ({} of {})", m.runs, c.runs) : "";
  return fixed(m.median, digits) + over;
}

Mark mark_of(const Comparison& c, const MethodVerdict& m) {
  return c.is_best_proven && m.is_leader ? Mark::best : Mark::none;
}

}  // namespace

TableView table_view(const Comparison& c) {
  const std::string unit = c.kind.unit.empty() ? "" : " [" + c.kind.unit + "]";
  TableView out{title(c),
                {"method",
                 "median" + unit,
                 "ratio",
                 fmt::format("{:g} % interval", 100.0 * (1.0 - c.options.alpha)),
                 "better/worse/equal",
                 "p",
                 "effect",
                 "rank",
                 "group"},
                {},
                {verdict(c)}};
  double largest = 0.0;
  for (const MethodVerdict& m : c.methods) largest = std::max(largest, std::abs(m.median));
  for (const MethodVerdict& m : c.methods) {
    const bool is_baseline = m.method == c.options.baseline;
    const auto unless_baseline = [&](const std::string& text) { return is_baseline ? "" : text; };
    out.lines.push_back(
        {{m.method, mark_of(c, m)},
         {median_text(c, m, decimals(largest))},
         {m.ratio ? fixed(m.ratio->estimate, 4) : "-"},
         {unless_baseline(
             m.has_interval ? fmt::format("{:.4f} .. {:.4f}", m.ratio->low, m.ratio->high) : "-")},
         {unless_baseline(fmt::format("{}/{}/{}", m.wins, m.losses, m.ties))},
         {unless_baseline(m.p ? p_text(*m.p) : "-")},
         {unless_baseline(fixed(m.rank_biserial, 2))},
         {rank_text(m)},
         {m.letters}});
  }
  for (const std::string& remark : remarks(c)) out.notes.push_back(remark);
  return out;
}

std::string csv(const std::vector<Comparison>& comparisons) {
  std::string out =
      "protocol,times,metric,label,relation,axis,unit,value,baseline,over,groups,runs,method,"
      "median,"
      "with_value,fails,ratio,ratio_low,ratio_high,better,worse,equal,p,rank_biserial,rank_low,"
      "rank_high,letters\n";
  for (const Comparison& c : comparisons) {
    for (const MethodVerdict& m : c.methods) {
      const auto bound = [&](double Interval::*end) {
        return m.has_interval ? fmt::format("{}", (*m.ratio).*end) : "";
      };
      out += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},",
                         quoted(c.kind.protocol),
                         c.kind.times.text(),
                         quoted(c.kind.metric),
                         quoted(metric_label(c.kind)),
                         c.kind.relation.text(),
                         c.kind.axis.text(),
                         c.kind.unit.text(),
                         c.options.value,
                         quoted(c.options.baseline),
                         over_name(c.options.over),
                         c.groups,
                         c.runs);
      out += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                         quoted(m.method),
                         m.runs > 0 ? fmt::format("{}", m.median) : "",
                         m.runs,
                         m.fails,
                         m.ratio ? fmt::format("{}", m.ratio->estimate) : "",
                         bound(&Interval::low),
                         bound(&Interval::high),
                         m.wins,
                         m.losses,
                         m.ties,
                         m.p ? fmt::format("{}", *m.p) : "",
                         m.rank_biserial,
                         m.lowest_rank,
                         m.highest_rank,
                         m.letters);
    }
  }
  return out;
}

std::string json(const std::vector<Comparison>& comparisons, int indent) {
  using Json = nlohmann::ordered_json;
  Json out = Json::array();
  for (const Comparison& c : comparisons) {
    Json entry{{"protocol", c.kind.protocol},
               {"protocol_version", c.kind.protocol_version},
               {"times", c.kind.times},
               {"metric", c.kind.metric},
               {"label", metric_label(c.kind)},
               {"relation", c.kind.relation},
               {"axis", c.kind.axis},
               {"unit", c.kind.unit},
               {"value", c.options.value},
               {"baseline", c.options.baseline},
               {"alpha", c.options.alpha},
               {"relevant", c.options.relevant},
               {"over", over_name(c.options.over)},
               {"unit_of_observation", unit_text(c)},
               {"groups", c.groups},
               {"runs", c.runs},
               {"possible", c.possible},
               {"best_is_proven", c.is_best_proven},
               {"verdict", verdict(c)},
               {"remarks", remarks(c)},
               {"oracle_methods", c.oracles},
               {"oracle_closures", c.oracle_closures},
               {"methods", Json::array()},
               {"gaps", Json::array()}};
    for (const MethodVerdict& m : c.methods) {
      Json ratio = nullptr;
      if (m.ratio) ratio = m.ratio->estimate;
      Json interval = nullptr;
      if (m.has_interval) interval = {m.ratio->low, m.ratio->high};
      entry["methods"].push_back({{"method", m.method},
                                  {"median", m.median},
                                  {"with_value", m.runs},
                                  {"fails", m.fails},
                                  {"coverage", m.coverage},
                                  {"ratio", ratio},
                                  {"interval", interval},
                                  {"why_no_interval", m.why_no_interval},
                                  {"better", m.wins},
                                  {"worse", m.losses},
                                  {"equal", m.ties},
                                  {"p", m.p ? Json(*m.p) : Json(nullptr)},
                                  {"rank_biserial", m.rank_biserial},
                                  {"ranks", {m.lowest_rank, m.highest_rank}},
                                  {"letters", m.letters}});
    }
    for (const Gap& gap : c.gaps) {
      entry["gaps"].push_back({{"method", gap.method},
                               {"missing", gap.missing},
                               {"why", gap.why},
                               {"ranked", gap.is_ranked}});
    }
    out.push_back(std::move(entry));
  }
  return out.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace loopbench::harness
