#include "harness/commands/eval/run_summary.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "harness/answers/tables/comparison.hpp"
#include "harness/answers/tables/pivot.hpp"
#include "harness/sweep/model/name_order.hpp"

namespace loopbench::harness {
namespace {

/// The score of a protocol that summarises runs.
std::optional<Record> run_score(const std::vector<Record>& records, const std::string& protocol) {
  std::optional<Record> first;
  std::optional<Record> first_axis;
  for (const Record& r : records) {
    if (!r.has_score() || r.kind->protocol != protocol) continue;
    if (r.kind->is_total() && r.kind->metric_label() == "ate" && r.kind->relation == "translation")
      return r;
    std::optional<Record>& known = r.kind->is_total() ? first : first_axis;
    if (!known && r.kind->better != metrics::Better::neither) known = r;
  }
  return first ? first : first_axis;
}

/// The scores, in translation and rotation, and the runs without any, as if under the same
/// protocol.
std::vector<Record> of_score(const std::vector<Record>& records, const Record& score) {
  std::vector<Record> out;
  for (const Record& r : records) {
    const bool is_own = r.kind->metric_label() == score.kind->metric_label() &&
                        r.kind->times == score.kind->times && r.kind->axis == score.kind->axis &&
                        r.kind->protocol == score.kind->protocol;
    if (!r.has_score() || is_own) out.push_back(r);
  }
  for (Record& r : out) r.kind.edit().protocol = score.kind->protocol;
  return out;
}

/// Whether a method has several runs on a sequence.
bool has_repeats(const std::vector<Record>& records) {
  std::map<std::pair<SharedText, SharedText>, std::set<std::int64_t>> runs;
  for (const Record& r : records) runs[{r.cell->sequence, r.cell->method}].insert(r.cell->repeat);
  return std::ranges::any_of(runs, [](const auto& each) { return each.second.size() > 1; });
}

/// Verdict and table of one score, each followed by an empty line.
std::string report_of(const std::vector<Record>& records,
                      const Record& score,
                      const std::string& title,
                      const std::optional<TerminalStyle>& style) {
  NameOrder methods;
  std::set<SharedText> with_values;
  for (const Record& r : records) {
    methods.index(r.cell->method);
    if (r.status == Status::ok) with_values.insert(r.cell->method);
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
    std::vector<Record> own = records;
    std::erase_if(own, [&](const Record& r) { return r.has_score() && r.kind != score.kind; });
    Table table = pivot(own, spec).front();
    table.title = title;
    out = (style ? terminal(table, *style) : markdown(table)) + "\n";
  }
  if (names.size() < 2) return out;
  CompareOptions options;
  options.baseline = *std::ranges::find_if(
      names, [&](const std::string& name) { return with_values.contains(SharedText(name)); });
  const std::vector<Comparison> all = compare(records, options);
  const auto main = std::ranges::find(
      all, score.kind->relation, [](const Comparison& c) { return c.kind.relation; });
  Table verdict = verdict_table(verdict_of(*main, all));
  for (const std::string& each : limitations(*main)) verdict.notes.push_back(each);
  const std::string text = style ? terminal(verdict, *style) : markdown(verdict);
  const bool ends_blank = !style && verdict.headings.empty() && verdict.notes.empty();
  return text + (ends_blank ? "" : "\n") + out;
}

}  // namespace

std::string run_report(const std::vector<Record>& records,
                       const std::optional<TerminalStyle>& style) {
  NameOrder protocols;
  for (const Record& r : records) {
    if (!r.kind->protocol.empty()) protocols.index(r.kind->protocol);
  }
  std::string out;
  for (const std::string& protocol : protocols.names()) {
    const std::optional<Record> score = run_score(records, protocol);
    if (!score) continue;
    const std::string title = protocols.names().size() > 1 ? protocol : "";
    out += report_of(of_score(records, *score), *score, title, style);
  }
  return out;
}

}  // namespace loopbench::harness
