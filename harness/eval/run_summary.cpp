#include "harness/eval/run_summary.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "harness/base/wrap.hpp"
#include "harness/compare/compare.hpp"
#include "harness/model/name_order.hpp"
#include "harness/tables/pivot.hpp"

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

/// The scores, and the runs without any, as if under the same protocol.
std::vector<Record> of_score(const std::vector<Record>& records, const Record& score) {
  std::vector<Record> out;
  for (const Record& r : records) {
    if (r.metric.empty() || is_score(r, score)) out.push_back(r);
  }
  for (Record& r : out) r.protocol = score.protocol;
  return out;
}

/// Whether a method has several runs on a sequence.
bool has_repeats(const std::vector<Record>& records) {
  std::map<std::pair<SharedText, SharedText>, std::set<std::int64_t>> runs;
  for (const Record& r : records) runs[{r.sequence, r.method}].insert(r.repeat);
  return std::ranges::any_of(runs, [](const auto& each) { return each.second.size() > 1; });
}

/// Indented after the first line.
std::string lines_of(const std::string& text, const std::optional<TerminalStyle>& style) {
  std::string out;
  for (const std::string& line : wrapped(text, style ? style->width - 2 : 0)) {
    out += (out.empty() ? "" : "  ") + line + "\n";
  }
  return out;
}

/// Table and verdict of one score.
std::string report_of(const std::vector<Record>& records,
                      const std::string& title,
                      const std::optional<TerminalStyle>& style,
                      bool paired) {
  NameOrder methods;
  std::set<SharedText> with_values;
  for (const Record& r : records) {
    methods.index(r.method);
    if (r.status == Status::ok) with_values.insert(r.method);
  }
  const std::vector<std::string>& names = methods.names();
  const bool is_several = has_repeats(records);
  if (with_values.empty() || (names.size() < 2 && !is_several)) return "";
  std::string out;
  if (is_several) {
    TableSpec spec;
    spec.rows = {"sequence", "method"};
    spec.split.clear();
    spec.plus_minus = true;
    Table table = pivot(records, spec).front();
    table.title = title;
    out += "\n" + (style ? terminal(table, *style) : markdown(table));
  }
  if (names.size() < 2) return out;
  CompareOptions options;
  options.baseline = *std::ranges::find_if(
      names, [&](const std::string& name) { return with_values.contains(SharedText(name)); });
  options.paired = paired;
  for (const Comparison& comparison : compare(records, options)) {
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
    const std::string title = protocols.size() > 1 ? protocol.text() : "";
    out += report_of(of_score(records, *score), title, style, paired);
  }
  return out;
}

}  // namespace loopbench::harness
