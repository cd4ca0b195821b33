#include "harness/answers/tables/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "datasets/core/fields.hpp"
#include "harness/answers/compare/stated.hpp"
#include "harness/answers/tables/record_csv.hpp"
#include "harness/sweep/text/counted.hpp"
#include "harness/sweep/text/wrap.hpp"

namespace loopbench::harness {
namespace {

std::string p_text(double p) { return p < 0.0001 ? "< 0.0001" : fmt::format("{:.4f}", p); }

/// With the number of runs if not all runs are included.
std::string median_text(const Comparison& c, const MethodVerdict& m, int digits) {
  if (m.runs == 0) return "-";
  const std::string over = m.fails > 0 ? fmt::format(" ({} of {})", m.runs, c.runs) : "";
  return fixed(m.median, digits) + (m.is_stated ? kStatedMark : "") + over;
}

using Json = nlohmann::ordered_json;

Json number_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

/// Changes that differ by less are printed as one.
constexpr double kPoint = 1.0;  // [%]

constexpr std::size_t kNoteWidth = kLineWidth - 2;

std::string optional_text(const std::optional<Change>& change, double narrow, int more = 0) {
  return change ? text(*change, narrow, more) : "-";
}

/// The largest logarithm of the ratios of a column.
double largest_change(const Verdict& verdict, std::size_t sequence) {
  double out = 0.0;
  for (const VerdictGroup& group : verdict.groups) {
    const auto& change = group.by_sequence[sequence];
    if (!change) continue;
    for (const double percent : {change->low, change->high})
      out = std::max(out, std::abs(std::log1p(percent / 100.0)));
  }
  return out;
}

/// Leaves as many sequences as fit into `most` characters, at least one: those of cautions, then
/// those with the largest changes.
void drop_sequences(Table& table, const Verdict& verdict, std::size_t most) {
  const auto line_width = [&] {
    std::size_t out = 1;
    for (std::size_t c = 0; c < table.headings.size(); ++c) {
      std::size_t column = width(table.headings[c]);
      for (const auto& line : table.lines) column = std::max(column, width(line[c].text));
      out += column + 3;
    }
    return out;
  };
  std::vector<std::pair<bool, double>> changes;
  for (std::size_t s = 0; s < verdict.sequences.size(); ++s) {
    const bool is_cautioned = std::ranges::count(verdict.cautioned, verdict.sequences[s]) > 0;
    changes.emplace_back(is_cautioned, largest_change(verdict, s));
  }
  std::size_t dropped = 0;
  for (; line_width() > most && changes.size() > 1; ++dropped) {
    const auto least = std::ranges::min_element(changes.rbegin(), changes.rend()).base() - 1;
    const auto column = 3 + (least - changes.begin());
    changes.erase(least);
    table.headings.erase(table.headings.begin() + column);
    for (auto& line : table.lines) line.erase(line.begin() + column);
  }
  if (dropped > 0)
    table.notes.emplace_back(counted(dropped, "sequence") + " more: compare --format json", "");
}

Json change_json(const std::optional<Change>& change) {
  return change ? Json{change->low, change->high} : Json();
}

Json groups_json(const Verdict& verdict) {
  Json out = Json::array();
  for (const VerdictGroup& group : verdict.groups) {
    Json by_sequence = Json::object();
    for (std::size_t s = 0; s < verdict.sequences.size(); ++s) {
      by_sequence[verdict.sequences[s]] = change_json(group.by_sequence[s]);
    }
    Json place;
    if (verdict.has_places) place = group.is_first ? "=" : ">";
    out.push_back({{"place", place},
                   {"name", group.name},
                   {"methods", group.methods},
                   {"change", change_json(group.all)},
                   {"interval", change_json(group.interval)},
                   {"by_sequence", by_sequence}});
  }
  return out;
}

Json score_json(const Comparison& c) {
  Json out = Json::object();
  for (const KindField& each : kKindFields) out[each.name] = c.kind.*each.text;
  out["label"] = c.kind.metric_label();
  out.update({{"value", c.options.value},
              {"baseline", c.options.baseline},
              {"alpha", c.options.alpha},
              {"tie", c.options.tie},
              {"relevant", c.options.relevant},
              {"over", c.options.over == Over::groups ? "groups" : "sequences"},
              {"unit_of_observation", unit_text(c)},
              {"groups", c.groups},
              {"runs", c.runs}});
  return out;
}

Json method_json(const MethodVerdict& m) {
  Json interval, mean, typical;
  Json by_sequence = Json::object();
  Json significant = Json::array();
  if (m.ratio) {
    typical = m.ratio->typical.estimate;
    mean = number_or_null(m.ratio->geometric_mean);
    if (m.ratio->has_interval) interval = {m.ratio->typical.low, m.ratio->typical.high};
    for (const SequenceRatio& one : m.ratio->by_sequence) {
      by_sequence[one.sequence] = one.ratio;
      if (one.is_clear) significant.push_back(one.sequence);
    }
  }
  return {{"method", m.method},
          {"median", m.median},
          {"with_value", m.runs},
          {"fails", m.fails},
          {"coverage", m.coverage},
          {"ratio", typical},
          {"interval", interval},
          {"geometric_mean", mean},
          {"by_sequence", by_sequence},
          {"significant_on", significant},
          {"better", m.wins},
          {"worse", m.losses},
          {"equal", m.ties},
          {"p", number_or_null(m.p)},
          {"stated", m.is_stated},
          {"place", m.is_worse ? ">" : "="}};
}

/// A field of CSV; empty: no number.
std::string csv_field(const Json& value) {
  if (value.is_string()) return quoted(value.get<std::string>());
  if (!value.is_number_float()) return value.is_null() ? "" : value.dump();
  const auto number = value.get<double>();
  return std::isnan(number) ? "" : fmt::format("{}", number);
}

}  // namespace

Table verdict_table(const Verdict& verdict, std::size_t width) {
  Table out{.title = verdict.sentence, .note_width = kNoteWidth};
  if (verdict.has_table()) {
    const int more = digits_of(verdict.groups, kPoint);
    out.headings = {"group", "change", fmt::format("{:g} %", verdict.level)};
    for (const std::string& sequence : verdict.sequences) out.headings.push_back(sequence);
    for (const VerdictGroup& group : verdict.groups) {
      std::vector<TableCell>& line = out.lines.emplace_back();
      const char* const place = group.is_first ? "= " : "> ";
      line = {(verdict.has_places ? place : "") + group.name,
              optional_text(group.all, kPoint, more),
              optional_text(group.interval, 0.0)};
      for (const auto& change : group.by_sequence) line.push_back(optional_text(change, kPoint));
    }
  }
  for (const std::string& caution : verdict.cautions) out.notes.push_back("! " + caution);
  if (!verdict.legend.empty()) out.notes.emplace_back(verdict.legend, verdict.legend_in_paper);
  if (width > 0) drop_sequences(out, verdict, width);
  return out;
}

Table table_view(const Comparison& c) {
  const std::string unit = c.kind.unit.empty() ? "" : " [" + c.kind.unit + "]";
  Table out{title(c),
            {"method",
             "median" + unit,
             "change [%]",
             fmt::format("{:g} %", 100.0 * (1.0 - c.options.alpha)),
             "better/worse",
             "p"},
            {},
            {}};
  const std::vector<std::string> in_paper = remarks(c, true);
  for (const std::string& each : remarks(c)) {
    out.notes.emplace_back(each, in_paper[out.notes.size()]);
  }
  double largest = 0.0;
  for (const MethodVerdict& m : c.methods) largest = std::max(largest, std::abs(m.median));
  std::vector<VerdictGroup> groups;
  for (const MethodVerdict& m : c.methods) groups.push_back(group_of({&m}, {}, c.options.baseline));
  const int more = digits_of(groups, 0.0);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const MethodVerdict& m = c.methods[i];
    const VerdictGroup& group = groups[i];
    const bool is_baseline = m.method == c.options.baseline;
    const auto unless_baseline = [&](const std::string& text) { return is_baseline ? "" : text; };
    const char* const place = m.is_worse ? "> " : "= ";
    out.lines.push_back({{(c.can_show ? place : "") + m.method, c.is_best && !m.is_worse},
                         {median_text(c, m, decimals(largest))},
                         {unless_baseline(optional_text(group.all, 0.0, more))},
                         {unless_baseline(optional_text(group.interval, 0.0))},
                         {unless_baseline(fmt::format("{}/{}", m.wins, m.losses))},
                         {unless_baseline(m.p ? p_text(*m.p) : "-")}});
  }
  out.facts = fmt::format("{} runs in {} independent groups", c.runs, c.groups);
  out.note_width = kNoteWidth;
  return out;
}

std::vector<Table> answer(const std::vector<Comparison>& all) {
  const Comparison* const found = headline(all);
  const Comparison& first = found != nullptr ? *found : all.front();
  std::vector<Table> out{verdict_table(verdict_of(first, all))};
  if (!first.methods.empty()) out.push_back(table_view(first));
  Table others{.title = "Other scores", .note_width = kNoteWidth};
  for (const Comparison& c : all) {
    if (&c != &first) others.notes.push_back(verdict_of(c, all).sentence);
  }
  if (!others.notes.empty()) out.push_back(std::move(others));
  return out;
}

std::string csv(const std::vector<Comparison>& comparisons) {
  const std::string columns =
      "protocol,times,metric,label,relation,axis,unit,value,baseline,over,groups,runs,method,"
      "median,with_value,fails,ratio,ratio_low,ratio_high,geometric_mean,better,worse,equal,p,";
  std::string out = columns + "place,stated\n";
  for (const Comparison& c : comparisons) {
    for (const MethodVerdict& m : c.methods) {
      Json all = score_json(c);
      all.update(method_json(m));
      if (!all["interval"].is_null()) {
        all["ratio_low"] = all["interval"][0];
        all["ratio_high"] = all["interval"][1];
      }
      std::istringstream names(columns);
      for (std::string name; std::getline(names, name, ',');) out += csv_field(all[name]) + ",";
      out += fmt::format("{},{}\n", m.is_worse ? ">" : "=", m.is_stated);
    }
  }
  return out;
}

std::string json(const std::vector<Comparison>& comparisons, int indent) {
  Json out = Json::array();
  for (const Comparison& c : comparisons) {
    const Verdict verdict = verdict_of(c, comparisons);
    Json entry = score_json(c);
    entry.update({{"possible", c.possible},
                  {"is_best", c.is_best},
                  {"tests", c.tests},
                  {"verdict", verdict.sentence},
                  {"groups_of_methods", groups_json(verdict)},
                  {"cautions", verdict.cautions},
                  {"legend", verdict.legend},
                  {"remarks", remarks(c)},
                  {"oracle_methods", c.oracles},
                  {"oracle_closures", c.oracle_closures},
                  {"methods", Json::array()},
                  {"gaps", Json::array()}});
    for (const MethodVerdict& m : c.methods) entry["methods"].push_back(method_json(m));
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
