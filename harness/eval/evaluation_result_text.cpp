#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "harness/eval/evaluation_text_parts.hpp"
#include "harness/tables/text.hpp"

namespace loopbench::harness {
namespace {

/// A table entry with the value of one record.
TableEntry number(double value) { return {.value = value, .records = 1, .averaged = 1}; }

std::string options_text(const Params& options) {
  std::string out;
  for (const auto& [name, value] : options) out += " " + name + "=" + to_text(value);
  return out;
}

double quoted_statistic(const metrics::Protocol& protocol, const metrics::Statistics& s) {
  if (protocol.statistic == metrics::Statistic::mean) return s.mean;
  return protocol.statistic == metrics::Statistic::median ? s.median : s.rmse;
}

std::string body_text(const EvaluationResult& result) {
  return result.reference_body.empty() ? "" : ", body offset " + result.reference_body;
}

/// "largest_gap 0.25 s, repeated 0, ...", wrapped.
std::string diagnosis_text(const std::vector<metrics::Score>& diagnosis) {
  std::string out;
  int count = 0;
  for (const metrics::Score& score : diagnosis) {
    const bool is_new_line = count++ % 4 == 0;
    out += is_new_line ? (out.empty() ? "diagnosis  " : ",\n           ") : ", ";
    out += fmt::format("{} {:.4g}", score.relation, score.statistics.mean);
    if (score.unit != "1") out += " " + score.unit;
  }
  return out + "\n";
}

bool is_total(const std::string& axis) { return axis == "3d" || axis == "all"; }

/// Follows a relation; empty for totals and scores without axis.
std::string axis_text(const std::string& axis) {
  return is_total(axis) || axis.empty() ? "" : " " + axis;
}

/// Without totals, as for `-r rpy`, tables show the axes.
bool has_total(const EvaluationResult& result) {
  return std::ranges::any_of(result.metrics, [](const EvaluatedMetric& metric) {
    return std::ranges::any_of(metric.scores,
                               [](const metrics::Score& score) { return is_total(score.axis); });
  });
}

/// Columns as wide as their content.
struct Widths {
  std::size_t metric = 13;
  std::size_t relation = 11;
  std::size_t axis = 4;
  std::size_t unit = 4;

  explicit Widths(const EvaluationResult& result) {
    for (const EvaluatedMetric& evaluated : result.metrics) {
      metric = std::max(metric, label(evaluated).size());
      for (const metrics::Score& score : evaluated.scores) {
        relation = std::max(relation, score.relation.size());
        axis = std::max(axis, score.axis.size());
        unit = std::max(unit, score.unit.size());
      }
    }
  }

  std::string line(const std::string& m,
                   const std::string& r,
                   const std::string& a,
                   const std::string& u) const {
    return fmt::format("{:<{}} {:<{}} {:<{}} {:<{}}", m, metric, r, relation, a, axis, u, unit);
  }
};

}  // namespace

std::string protocol_text(const metrics::NamedProtocol& protocol) {
  return fmt::format("{} [{}]", protocol.label(), protocol.version);
}

std::vector<Missing> missing_scores(const EvaluationResult& result, const std::string& row) {
  std::vector<Missing> out;
  for (const EvaluatedMetric& metric : result.metrics) {
    if (!metric.why_undefined.empty()) {
      out.push_back({row, label(metric), "undefined", metric.why_undefined});
    }
    if (!metric.why_failed.empty()) {
      out.push_back({row, label(metric), "failed", metric.why_failed});
    }
    for (const auto& [relation, axis, unit, s, why, better, target] : metric.scores) {
      if (why.empty()) continue;
      const std::string what = label(metric) + " " + relation + axis_text(axis);
      out.push_back({row, what, "undefined", why});
    }
  }
  return out;
}

std::string label(const EvaluatedMetric& metric) {
  Params rest = metric.options;
  for (const char* in_heading : {"relation", "each"}) rest.erase(in_heading);
  const auto delta = rest.find("delta");
  const auto unit = rest.find("unit");
  if (delta == rest.end() || unit == rest.end()) return metric.name + options_text(rest);
  std::string out =
      fmt::format("{} {} {}", metric.name, std::get<double>(delta->second), to_text(unit->second));
  rest.erase("delta");
  rest.erase("unit");
  return out + options_text(rest);
}

std::string text(const EvaluationResult& result) {
  std::string out =
      fmt::format("reference  {} ({} poses){}\n",
                  result.reference,
                  result.reference_poses,
                  body_text(result)) +
      fmt::format("estimate   {} ({} poses)\n", result.estimate, result.estimate_poses) +
      fmt::format("protocol   {}\n", protocol_text(result.protocol)) +
      fmt::format("pairs      {} of {} ({:.1f} %), over {:.1f} % of the reference's time\n",
                  result.coverage.pairs,
                  result.coverage.possible,
                  100.0 * result.coverage.share(),
                  100.0 * result.coverage.span) +
      (result.incomplete_reason.empty() ? "" : "incomplete " + result.incomplete_reason + "\n") +
      fmt::format(
          "alignment  {}, scale {}\n", to_text(result.alignment.type), result.alignment.scale) +
      diagnosis_text(result.diagnosis) +
      (result.other_body.empty() ? "" : "other body " + result.other_body + "; see --ref-body\n");
  for (const std::string& note : result.notes) out += "note       " + note + "\n";
  out += "\n";
  const Widths widths(result);
  out += widths.line("metric", "relation", "axis", "unit");
  for (const char* name : {"rmse", "mean", "median", "std", "min", "max"}) {
    out += fmt::format(" {:>12}", name);
  }
  out += fmt::format(" {:>9}\n", "count");
  for (const EvaluatedMetric& metric : result.metrics) {
    for (const auto& [relation, axis, unit, s, why, better, target] : metric.scores) {
      if (!why.empty()) continue;
      out += widths.line(label(metric), relation, axis, unit);
      for (const double value : {s.rmse, s.mean, s.median, s.std, s.min, s.max}) {
        out += fmt::format(" {:>12.6f}", value);
      }
      out += fmt::format(" {:>9}\n", s.count);
    }
  }
  for (const std::string& note : grouped(missing_scores(result, ""))) out += note + "\n";
  return out;
}

std::vector<Table> comparison(const std::vector<EvaluationResult>& results) {
  const bool has_totals = std::ranges::any_of(results, has_total);
  std::vector<Table> tables;
  std::vector<std::map<std::string, std::size_t>> columns;  // per table
  std::vector<std::vector<Missing>> missing;                // per table
  for (const EvaluationResult& result : results) {
    const metrics::Protocol& rules = result.protocol.rules;
    const std::string title = fmt::format("{}, {} against {}{}",
                                          protocol_text(result.protocol),
                                          to_text(rules.statistic),
                                          result.reference,
                                          body_text(result));
    auto table = std::ranges::find(tables, title, &Table::title);
    if (table == tables.end()) {
      table = tables.insert(tables.end(), Table{title, "estimate", {}, {}, {}, {}});
      columns.emplace_back();
      missing.emplace_back();
    }
    auto& known = columns[static_cast<std::size_t>(table - tables.begin())];
    std::vector<TableEntry>& row = table->entries.emplace_back(table->columns.size());
    table->rows.push_back(result.estimate);
    const auto put = [&](const std::string& column, TableEntry entry) {
      const auto [index, is_new] = known.emplace(column, table->columns.size());
      if (is_new) table->columns.push_back(column);
      row.resize(table->columns.size());
      row[index->second] = std::move(entry);
    };
    const bool is_failed = !result.why_failed.empty();
    const auto percent = [&](double share) {
      return is_failed ? TableEntry{.status = "failed"} : number(100.0 * share);
    };
    put("poses [%]", percent(result.coverage.share()));
    put("time [%]", percent(result.coverage.span));
    std::vector<Missing>& notes = missing[static_cast<std::size_t>(table - tables.begin())];
    if (!result.incomplete_reason.empty()) {
      notes.push_back({result.estimate, "", "incomplete", result.incomplete_reason});
    }
    if (is_failed) notes.push_back({result.estimate, "", "failed", result.why_failed});
    if (!result.other_body.empty())
      notes.push_back({result.estimate, "", "other body", result.other_body});
    for (const std::string& note : result.notes)
      notes.push_back({result.estimate, "", "note", note});
    for (Missing& note : missing_scores(result, result.estimate)) notes.push_back(std::move(note));
    for (const EvaluatedMetric& metric : result.metrics) {
      for (const auto& [relation, axis, unit, s, why, better, target] : metric.scores) {
        if ((has_totals && !is_total(axis)) || !why.empty()) continue;
        const std::string what = relation + axis_text(axis);
        const std::string column = fmt::format("{} {} [{}]", label(metric), what, unit);
        if (result.incomplete_reason.empty()) {
          put(column, number(quoted_statistic(rules, s)));
          if (metric.name == "rpe" && axis == "3d") {
            put(label(metric) + " pairs", number(static_cast<double>(s.count)));
          }
        } else {
          put(column, {.status = "incomplete"});
        }
      }
    }
  }
  for (std::size_t t = 0; t < tables.size(); ++t) {
    tables[t].notes = grouped(missing[t]);
    for (std::vector<TableEntry>& row : tables[t].entries) {
      row.resize(tables[t].columns.size());
      if (row.front().status == "failed") std::ranges::fill(row, row.front());
    }
  }
  return tables;
}

}  // namespace loopbench::harness
