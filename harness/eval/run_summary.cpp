#include "harness/eval/run_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "harness/base/wrap.hpp"

namespace loopbench::harness {
namespace {

bool is_total_score(const Record& r) { return r.axis.empty() || r.axis == "3d" || r.axis == "all"; }

/// The score of a protocol that summarises runs.
std::optional<Record> run_score(const std::vector<Record>& records, const SharedText& protocol) {
  std::optional<Record> first;
  std::optional<Record> first_axis;
  for (const Record& r : records) {
    if (r.metric.empty() || r.protocol != protocol) continue;
    if (is_total_score(r) && metric_label(r) == "ate" && r.relation == "translation") return r;
    std::optional<Record>& known = is_total_score(r) ? first : first_axis;
    if (!known && r.better != metrics::Better::neither) known = r;
  }
  return first ? first : first_axis;
}

bool is_score(const Record& r, const Record& score) {
  return !r.metric.empty() && r.protocol == score.protocol &&
         metric_label(r) == metric_label(score) && r.relation == score.relation &&
         r.axis == score.axis && r.unit == score.unit;
}

/// The protocols in order of appearance.
std::vector<SharedText> protocols_of(const std::vector<Record>& records) {
  std::vector<SharedText> out;
  for (const Record& r : records) {
    if (!r.protocol.empty() && std::ranges::count(out, r.protocol) == 0) out.push_back(r.protocol);
  }
  return out;
}

/// Runs of one method on one sequence. Runs with equal data have the same content.
struct CountedRuns {
  std::set<std::int64_t> repeats;
  std::set<std::string> contents;
  std::map<std::string, double> values;  ///< of the successes, by content
};

/// Runs whose content is unknown are different.
std::string content_key(const Record& r) {
  return r.content.empty() ? "run " + std::to_string(r.repeat) : r.content.text();
}

RunSummary summary(const std::string& sequence,
                   const std::string& method,
                   const CountedRuns& counted) {
  RunSummary out{sequence,
                 method,
                 counted.contents.size(),
                 counted.repeats.size() - counted.contents.size(),
                 {},
                 {}};
  std::vector<double> values;
  for (const auto& [content, value] : counted.values) values.push_back(value);
  if (values.empty()) return out;
  std::ranges::sort(values);
  out.values = metrics::statistics(values);
  out.interval = shift_interval(values, 0.05);
  return out;
}

std::vector<TableCell> row(const RunSummary& s) {
  const auto number = [](double value) { return fmt::format("{:.4f}", value); };
  std::vector<TableCell> out{{s.sequence + " / " + s.method},
                             {fmt::format("{} of {}", s.values.count, s.runs)}};
  if (s.values.count == 0) {
    out.resize(6);
    return out;
  }
  const auto range = [&](double low, double high) { return number(low) + " to " + number(high); };
  out.push_back({number(s.values.mean)});
  out.push_back({s.interval ? range(s.interval->low, s.interval->high) : "-"});
  out.push_back({number(s.values.median)});
  out.push_back({range(s.values.min, s.values.max)});
  return out;
}

/// Indented after the first line.
std::string lines_of(const std::string& text, const std::optional<TerminalStyle>& style) {
  std::string out;
  for (const std::string& line : wrapped(text, style ? style->width - 2 : 0)) {
    out += (out.empty() ? "" : "  ") + line + "\n";
  }
  return out;
}

std::string table_of(const std::vector<RunSummary>& all,
                     const std::string& subject,
                     const std::string& unit,
                     const std::optional<TerminalStyle>& style) {
  Table view{"",
             {"sequence / method",
              "successful runs",
              "mean " + subject + " [" + unit + "]",
              "95 % interval",
              "median [" + unit + "]",
              "range [" + unit + "]"},
             {},
             {}};
  for (const RunSummary& each : all) view.lines.push_back(row(each));
  std::size_t copies = 0;
  for (const RunSummary& each : all) copies += each.copies;
  std::string out = style ? terminal(view, *style) : markdown(view);
  if (copies > 0) {
    out += "\n" + lines_of(fmt::format("- {} of the files {} the data of another run of {} method "
                                       "and count{} once with it",
                                       copies,
                                       copies == 1 ? "repeats" : "repeat",
                                       copies == 1 ? "its" : "their",
                                       copies == 1 ? "s" : ""),
                           style);
  }
  return out;
}

}  // namespace

std::vector<RunSummary> summarise_runs(const std::vector<Record>& records, const Record& score) {
  using Key = std::pair<std::string, std::string>;
  std::vector<Key> order;
  std::map<Key, CountedRuns> runs;
  for (const Record& r : records) {
    const Key key{r.sequence, r.method};
    CountedRuns& counted = runs[key];
    if (counted.repeats.empty()) order.push_back(key);
    counted.repeats.insert(r.repeat);
    counted.contents.insert(content_key(r));
    if (r.status == Status::ok && is_score(r, score)) {
      counted.values.emplace(content_key(r), r.statistics.rmse);
    }
  }
  std::vector<RunSummary> out;
  for (const Key& key : order) {
    out.push_back(summary(key.first, key.second, runs[key]));
  }
  return out;
}

namespace {

/// Table and verdict of one score; `subject` names it.
std::string report_of(const std::vector<Record>& records,
                      const Record& score,
                      const std::string& subject,
                      const std::optional<TerminalStyle>& style,
                      bool paired) {
  const std::vector<RunSummary> all = summarise_runs(records, score);
  std::set<std::string> methods;
  for (const RunSummary& each : all) methods.insert(each.method);
  const bool has_repeats =
      std::ranges::any_of(all, [](const RunSummary& each) { return each.runs + each.copies > 1; });
  const bool has_values =
      std::ranges::any_of(all, [](const RunSummary& each) { return each.values.count > 0; });
  if (!has_values || (methods.size() < 2 && !has_repeats)) return "";
  std::string out;
  if (has_repeats) out += "\n" + table_of(all, subject, score.unit, style);
  if (methods.size() < 2) return out;
  std::vector<Record> scores;
  for (const Record& r : records) {
    const bool is_failed_run =
        r.metric.empty() && (r.protocol.empty() || r.protocol == score.protocol);
    if (is_failed_run || is_score(r, score)) scores.push_back(r);
  }
  CompareOptions options;
  options.baseline = records.front().method;
  options.paired = paired;
  for (const Comparison& comparison : compare(scores, options)) {
    out += "\n" + lines_of("verdict: " + statement(comparison), style);
    for (const std::string& limit : conditions(comparison)) out += lines_of("- " + limit, style);
  }
  return out;
}

}  // namespace

std::string run_report(const std::vector<Record>& records,
                       const std::optional<TerminalStyle>& style,
                       bool paired) {
  const std::vector<SharedText> protocols = protocols_of(records);
  std::string out;
  for (const SharedText& protocol : protocols) {
    const std::optional<Record> score = run_score(records, protocol);
    if (!score) continue;
    std::string subject = metric_label(*score);
    if (!is_total_score(*score)) subject += " " + score->axis;
    if (protocols.size() > 1) subject += " (" + protocol + ")";
    out += report_of(records, *score, subject, style, paired);
  }
  return out;
}

}  // namespace loopbench::harness
