#include <set>
#include <tuple>

#include "harness/report/html.hpp"
#include "harness/report/sections.hpp"

namespace loopbench::harness {
namespace {

std::string listed(const std::set<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

using Reason = std::tuple<std::string, std::string, std::string>;  // status, method, why

struct Affected {
  std::set<std::int64_t> cells;
  std::set<std::string> sequences;
  std::set<std::string> scores;
};

/// Cells without scores, or with too little coverage.
Table of_cells(const ReportContent& content) {
  std::map<Reason, Affected> reasons;
  for (const CellRecord& cell : content.cells) {
    if (cell.status == Status::ok && cell.why.empty()) continue;
    const std::string status = cell.status == Status::ok ? "not evaluated" : to_text(cell.status);
    const std::string why =
        cell.signal.empty() ? cell.why.text() : cell.signal + ": " + cell.why.text();
    Affected& affected = reasons[{status, cell.method, why}];
    affected.cells.insert(cell.position);
    affected.sequences.insert(cell.sequence);
  }
  Table out{"cells without results", {"method", "status", "cells", "sequences", "why"}, {}, {}};
  for (const auto& [reason, affected] : reasons) {
    const auto& [status, method, why] = reason;
    out.lines.push_back(
        {method, status, std::to_string(affected.cells.size()), listed(affected.sequences), why});
  }
  return out;
}

/// Scores missing from cells that finished.
Table of_scores(const ReportContent& content) {
  std::set<std::int64_t> ended;
  for (const CellRecord& cell : content.cells) {
    if (has_numbers(cell.status)) ended.insert(cell.position);
  }
  std::map<Reason, Affected> reasons;
  for (const Record& r : content.undefined) {
    if (!ended.contains(r.cell)) continue;
    Affected& affected = reasons[{to_text(r.status), r.method, r.why}];
    affected.cells.insert(r.cell);
    affected.sequences.insert(r.sequence);
    affected.scores.insert(field(r, "score") + (r.unit.empty() ? "" : " [" + r.unit + "]"));
  }
  Table out{
      "undefined scores", {"method", "status", "scores", "cells", "sequences", "why"}, {}, {}};
  for (const auto& [reason, affected] : reasons) {
    const auto& [status, method, why] = reason;
    out.lines.push_back({method,
                         status,
                         listed(affected.scores),
                         std::to_string(affected.cells.size()),
                         listed(affected.sequences),
                         why});
  }
  return out;
}

}  // namespace

std::string failures_html(const ReportContent& content) {
  std::string out;
  for (const Table& listing : {of_cells(content), of_scores(content)}) {
    if (!listing.lines.empty()) out += html_text_table(listing);
  }
  if (!out.empty()) return out;
  return "<p>Every cell finished and every score has a value.</p>\n";
}

}  // namespace loopbench::harness
