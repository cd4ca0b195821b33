#include "harness/eval/run_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "harness/base/wrap.hpp"
#include "harness/compare/compare.hpp"
#include "harness/compare/signed_rank.hpp"

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

/// Runs of one method on one sequence. Runs with equal data have the same content and count once.
struct CountedRuns {
  std::string sequence;
  std::string method;
  std::set<std::int64_t> repeats = {};
  std::set<std::string> contents = {};
  std::map<std::string, double> values = {};  ///< of the successes, by content

  std::size_t copies() const { return repeats.size() - contents.size(); }
};

/// By sequence and method, in the order of the records.
std::vector<CountedRuns> counted_runs(const std::vector<Record>& records, const Record& score) {
  std::vector<CountedRuns> out;
  using Key = std::pair<std::string, std::string>;
  std::map<Key, std::size_t> places;
  for (const Record& r : records) {
    const auto [place, is_new] = places.emplace(Key(r.sequence, r.method), out.size());
    if (is_new) out.push_back({r.sequence, r.method});
    CountedRuns& runs = out[place->second];
    // Runs whose content is unknown are different.
    const std::string content =
        r.content.empty() ? "run " + std::to_string(r.repeat) : r.content.text();
    runs.repeats.insert(r.repeat);
    runs.contents.insert(content);
    if (r.status == Status::ok && is_score(r, score)) {
      runs.values.emplace(content, r.statistics.rmse);
    }
  }
  return out;
}

std::vector<TableCell> row(const CountedRuns& runs) {
  const auto number = [](double value) { return fixed(value, std::max(4, decimals(value))); };
  const auto range = [&](double low, double high) { return number(low) + " to " + number(high); };
  std::vector<TableCell> out{{runs.sequence + " / " + runs.method},
                             {fmt::format("{} of {}", runs.values.size(), runs.contents.size())}};
  std::vector<double> values;
  for (const auto& [content, value] : runs.values) values.push_back(value);
  if (values.empty()) {
    out.resize(6);
    return out;
  }
  std::ranges::sort(values);
  const metrics::Statistics all = metrics::statistics(values);
  const std::optional<Interval> interval = shift_interval(values, 0.05);
  out.push_back({number(all.mean)});
  out.push_back({interval ? range(interval->low, interval->high) : "-"});
  out.push_back({number(all.median)});
  out.push_back({range(all.min, all.max)});
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

std::string table_of(const std::vector<CountedRuns>& all,
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
  for (const CountedRuns& each : all) view.lines.push_back(row(each));
  std::size_t copies = 0;
  for (const CountedRuns& each : all) copies += each.copies();
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

/// Table and verdict of one score; `subject` names it.
std::string report_of(const std::vector<Record>& records,
                      const Record& score,
                      const std::string& subject,
                      const std::optional<TerminalStyle>& style,
                      bool paired) {
  const std::vector<CountedRuns> all = counted_runs(records, score);
  std::set<std::string> methods;
  for (const CountedRuns& each : all) methods.insert(each.method);
  const bool has_repeats =
      std::ranges::any_of(all, [](const CountedRuns& each) { return each.repeats.size() > 1; });
  const bool has_values =
      std::ranges::any_of(all, [](const CountedRuns& each) { return !each.values.empty(); });
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
  // The first method with a value.
  options.baseline = std::ranges::find_if(all, [&](const CountedRuns& each) {
                       return std::ranges::any_of(all, [&](const CountedRuns& other) {
                         return other.method == each.method && !other.values.empty();
                       });
                     })->method;
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
