#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <tuple>

#include "harness/answers/report/sections.hpp"

namespace loopbench::harness {
namespace {

using Reason = std::tuple<std::string, std::string, std::string>;  // status, method, why

struct Affected {
  std::set<std::int64_t> cells;
  std::set<std::string> sequences;
  std::set<std::string> scores;
};

/// One line per reason; with a column for the scores if there are any.
std::string reasons_table(const std::string& title,
                          const ReportWords& words,
                          const std::map<Reason, Affected>& reasons,
                          bool has_scores) {
  if (reasons.empty()) return "";
  Table out{title, {words.one, "status"}, {}, {}};
  if (has_scores) out.headings.emplace_back("scores");
  out.headings.emplace_back(words.cells);
  for (const char* heading : {"sequences", "why"}) out.headings.emplace_back(heading);
  const auto listed = [](const auto& names) { return fmt::format("{}", fmt::join(names, ", ")); };
  for (const auto& [reason, affected] : reasons) {
    const auto& [status, method, why] = reason;
    std::vector<TableCell>& line = out.lines.emplace_back();
    line = {method, status};
    if (has_scores) line.emplace_back(listed(affected.scores));
    line.emplace_back(std::to_string(affected.cells.size()));
    line.emplace_back(listed(affected.sequences));
    line.emplace_back(why);
  }
  return html_text_table(out);
}

/// Cells without scores, or with too little coverage.
std::map<Reason, Affected> reasons_of_cells(const ReportContent& content) {
  std::map<Reason, Affected> out;
  for (const CellRow& cell : content.cells) {
    if (cell.status == Status::ok && cell.why.empty()) continue;
    const std::string status = cell.status == Status::ok ? "not evaluated" : to_text(cell.status);
    const std::string why =
        cell.signal.empty() ? cell.why.text() : cell.signal + ": " + cell.why.text();
    Affected& affected = out[{status, cell.method, why}];
    affected.cells.insert(cell.position);
    affected.sequences.insert(cell.sequence);
  }
  return out;
}

/// Scores missing from cells that finished.
std::map<Reason, Affected> reasons_of_scores(const ReportContent& content) {
  std::set<std::int64_t> finished;
  for (const CellRow& cell : content.cells) {
    if (has_numbers(cell.status)) finished.insert(cell.position);
  }
  std::map<Reason, Affected> out;
  for (const Record& r : content.undefined) {
    if (!finished.contains(r.cell->position)) continue;
    Affected& affected = out[{to_text(r.status), r.cell->method, r.why}];
    affected.cells.insert(r.cell->position);
    affected.sequences.insert(r.cell->sequence);
    affected.scores.insert(r.kind->short_name() +
                           (r.kind->unit.empty() ? "" : " [" + r.kind->unit + "]"));
  }
  return out;
}

}  // namespace

std::string failures_html(const ReportContent& content) {
  const ReportWords words = words_of(content);
  const std::string out =
      reasons_table(
          std::string(words.cells) + " without results", words, reasons_of_cells(content), false) +
      reasons_table("undefined or incomplete scores", words, reasons_of_scores(content), true);
  if (!out.empty()) return out;
  return fmt::format("<p>Every {} finished and every score has a value.</p>\n", words.cell);
}

}  // namespace loopbench::harness
