#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "harness/answers/report/sections.hpp"
#include "harness/answers/tables/comparison.hpp"
#include "metrics/numerics/average.hpp"

namespace loopbench::harness {
namespace {

/// The first score in large type, for a single method.
std::string only_score(const ReportContent& content) {
  const auto first = std::ranges::find_if(
      content.records, [](const Record& r) { return r.has_score() && r.status == Status::ok; });
  if (first == content.records.end()) return "";
  return fmt::format(
      "<div class=\"key\"><span class=\"number\">{:.4g} {}</span><span class=\"what\">{} of "
      "<b>{}</b>, rmse, {}, {}</span></div>\n",
      first->statistics.rmse,
      html_text(first->kind->unit),
      html_text(first->kind->short_name()),
      html_text(first->cell->method.text()),
      html_text(first->kind->times),
      html_text(first->kind->protocol));
}

/// A row of a table of methods.
struct MethodRow {
  std::string method;
  std::string place = {};  ///< "= " or "> ", or empty
  bool is_own = false;     ///< a program or plugin of the user
  std::vector<std::string> cells;
};

bool is_own(const ReportContent& content, const std::string& method) {
  return std::ranges::any_of(content.cells, [&](const CellRow& cell) {
    return cell.method == method && is_own(cell.parts);
  });
}

/// The rows have their methods as data, for the scripts of the page.
std::string rows_html(const std::string& title,
                      const std::vector<std::string>& headings,
                      const std::vector<MethodRow>& rows) {
  std::string out = fmt::format(
      "<figure class=\"table methods\"><div class=\"scroll\" tabindex=\"0\" role=\"region\" "
      "aria-label=\"{0}\"><table><caption>{0}</caption><thead><tr>",
      html_text(title));
  for (const std::string& heading : headings)
    out += "<th scope=\"col\">" + html_text(heading) + "</th>";
  out += "</tr></thead><tbody>\n";
  for (const MethodRow& row : rows) {
    out += fmt::format("<tr data-method=\"{0}\"{1}><th scope=\"row\">{2}<span>{0}</span>{3}</th>",
                       html_text(row.method),
                       row.is_own ? " class=\"own\"" : "",
                       html_text(row.place),
                       row.is_own ? " <small>own</small>" : "");
    for (const std::string& cell : row.cells) out += "<td>" + html_text(cell) + "</td>";
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>";
}

std::string notes_of(const std::vector<std::string>& notes) {
  std::string out;
  for (const std::string& note : notes) out += "<li>" + html_text(note) + "</li>";
  return out.empty() ? "" : "<ul class=\"notes\">" + out + "</ul>";
}

std::string unit_heading(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " [" + unit + "]";
}

std::string change_text(const std::optional<Change>& change, double narrow) {
  return change ? text(*change, narrow) : "-";
}

/// All methods of a comparison in its order, the best first, then those without a value.
std::string methods_html(const ReportContent& content, const Comparison& c) {
  const Verdict verdict = verdict_of(c, content.comparisons);
  std::vector<std::string> headings{
      words_of(content).one,
      unit_heading((c.runs > 1 ? "median " : "") + std::string(c.kind.metric_label()), c.kind.unit),
      "change [%]",
      fmt::format("{:g} %", 100.0 * (1.0 - c.options.alpha))};
  for (const std::string& sequence : verdict.sequences) headings.push_back(sequence);
  double largest = 0.0;
  for (const MethodVerdict& m : c.methods) largest = std::max(largest, std::abs(m.median));
  std::vector<MethodRow> rows;
  for (const MethodVerdict& m : c.methods) {
    const VerdictGroup group = group_of({&m}, verdict.sequences, c.options.baseline);
    MethodRow& row = rows.emplace_back(MethodRow{.method = m.method, .cells = {}});
    if (c.can_show) row.place = m.is_worse ? "> " : "= ";
    row.is_own = is_own(content, m.method);
    const bool is_baseline = m.method == c.options.baseline;
    row.cells = {m.runs == 0 ? "-" : fixed(m.median, decimals(largest)),
                 is_baseline ? "" : change_text(group.all, 0.0),
                 is_baseline ? "" : change_text(group.interval, 0.0)};
    for (const auto& change : group.by_sequence)
      row.cells.push_back(is_baseline ? "" : change_text(change, 1.0));
  }
  std::vector<std::string> notes;
  for (const std::string& caution : verdict.cautions) notes.push_back("! " + caution);
  for (const Gap& gap : c.gaps) {
    if (gap.is_ranked) continue;
    MethodRow& row = rows.emplace_back(MethodRow{.method = gap.method, .cells = {}});
    row.is_own = is_own(content, gap.method);
    row.cells.resize(headings.size() - 1, "-");
    notes.push_back(gap.method + ": " + gap.why);
  }
  if (!verdict.legend.empty()) notes.push_back(verdict.legend);
  return rows_html(title(c), headings, rows) + notes_of(notes) + "</figure>\n";
}

/// The score that a page begins with: the first ATE in translation, dense if there is one.
const Record* first_error(const ReportContent& content) {
  const Record* out = nullptr;
  int best = -1;
  for (const Record& r : content.records) {
    if (!r.has_score() || r.kind->better != metrics::Better::lower || r.kind->metric == "time")
      continue;
    const bool is_ate =
        r.kind->metric == "ate" && r.kind->relation == "translation" && r.kind->axis == "3d";
    const int rank = (is_ate ? 2 : 0) + (r.kind->times == "dense" ? 1 : 0);
    if (rank <= best) continue;
    best = rank;
    out = &r;
  }
  return out;
}

/// All methods by their mean error over the runs that they finished, without a comparison.
std::string errors_html(const ReportContent& content) {
  const Record* const first = first_error(content);
  if (first == nullptr) return "";
  std::map<std::string, std::vector<double>> values;
  for (const Record& r : content.records) {
    if (r.has_score() && *r.kind == *first->kind && has_numbers(r.status))
      values[r.cell->method].push_back(r.statistics.rmse);
  }
  std::vector<std::pair<double, MethodRow>> sorted;
  double largest = 0.0;
  for (const auto& [method, all] : values) largest = std::max(largest, metrics::mean(all));
  for (const std::string& method : content.methods) {
    const auto found = values.find(method);
    const bool has_value = found != values.end();
    const double mean = has_value ? metrics::mean(found->second) : HUGE_VAL;
    const std::string number = has_value ? fixed(mean, decimals(largest)) : "-";
    const std::string runs = std::to_string(has_value ? found->second.size() : 0);
    sorted.emplace_back(
        mean,
        MethodRow{.method = method, .is_own = is_own(content, method), .cells = {number, runs}});
  }
  std::ranges::stable_sort(sorted, {}, [](const auto& each) { return each.first; });
  std::vector<MethodRow> rows;
  for (auto& each : sorted) rows.push_back(std::move(each.second));
  const std::string name = first->kind->short_name() + ", rmse";
  return rows_html(name + ", " + first->kind->times + ", " + first->kind->protocol,
                   {words_of(content).one, unit_heading(name, first->kind->unit), "runs"},
                   rows) +
         "</figure>\n";
}

/// What each loop closure that the reference gave means for the result; empty if there is none.
std::string oracle_html(const ReportContent& content) {
  std::set<std::string> measured;
  for (const CellRow& cell : content.cells) {
    if (cell.oracle_closures) measured.insert(cell.sequence);
  }
  if (measured.empty()) return "";
  const bool are_all = measured.size() == content.sequences.size();
  return "<p class=\"warning\">" +
         html_text(are_all ? "all sequences" : fmt::format("{}", fmt::join(measured, ", "))) +
         ": loop closures were measured in the reference or selected by it (oracle), which is "
         "better than any detector.</p>\n";
}

/// The verdict of each score.
std::string verdicts_html(const ReportContent& content) {
  const Comparison* headline = content.headline();
  if (headline == nullptr && content.methods.size() == 1) return only_score(content);
  std::string out = fmt::format(
      "<div data-comparison=\"\"{}><p class=\"verdict\">No verdict: there is no baseline, or fewer "
      "than two {}s with a common run and this score.</p>\n{}</div>\n",
      headline == nullptr ? "" : " hidden",
      words_of(content).one,
      headline == nullptr ? errors_html(content) : "");
  for (const Comparison& c : content.comparisons) {
    if (c.methods.size() < 2) continue;
    out += fmt::format("<div data-comparison=\"{}\"{}><p class=\"verdict\">{}</p>\n",
                       &c - content.comparisons.data(),
                       &c == headline ? "" : " hidden",
                       html_text(verdict_of(c, content.comparisons).sentence));
    out += methods_html(content, c);
    if (!c.oracles.empty()) {
      out += "<p class=\"warning\">Excluded from verdicts because they use the reference: " +
             html_text(fmt::format("{}", fmt::join(c.oracles, ", "))) + "</p>\n";
    }
    out += "</div>\n";
  }
  return out + oracle_html(content);
}

}  // namespace

std::string answers_html(const ReportContent& content) {
  const std::string decisive = notes_html(content, Severity::decisive);
  return (decisive.empty() ? "" : "<div class=\"warning\">" + decisive + "</div>\n") +
         verdicts_html(content);
}

}  // namespace loopbench::harness
