#include "harness/answers/tables/gate_comment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "harness/answers/tables/gate_table.hpp"
#include "harness/answers/tables/table.hpp"
#include "harness/sweep/text/counted.hpp"
#include "harness/sweep/text/wrap.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kCommentMethods = 40;
constexpr std::size_t kMostNotes = 10;
constexpr std::size_t kNameColumns = 60;
constexpr std::size_t kTextColumns = 160;

/// The findings of a method or of a cell.
struct FindingGroup {
  std::size_t regressions = 0;
  std::size_t improvements = 0;
  std::size_t added = 0;
  const Finding* worst = nullptr;

  std::size_t all() const { return regressions + improvements + added; }
};

bool is_worse_finding(const Finding& a, const Finding& b) {
  if (a.kind != b.kind) return a.kind < b.kind;
  return a.change > b.change;
}

void add(FindingGroup& to, const Finding& finding) {
  if (finding.kind == Finding::Kind::regression) ++to.regressions;
  if (finding.kind == Finding::Kind::improvement) ++to.improvements;
  if (finding.kind == Finding::Kind::added) ++to.added;
  if (to.worst == nullptr || is_worse_finding(finding, *to.worst)) to.worst = &finding;
}

/// The worst first; equal ones in the order of their first finding.
std::vector<FindingGroup> worst_first(const GateReport& report, std::string Finding::*key) {
  std::map<std::string, std::size_t> place;
  std::vector<FindingGroup> out;
  for (const Finding& finding : report.findings) {
    const auto [found, is_new] = place.emplace(finding.*key, out.size());
    if (is_new) out.emplace_back();
    add(out[found->second], finding);
  }
  std::ranges::stable_sort(out, [](const FindingGroup& a, const FindingGroup& b) {
    return is_worse_finding(*a.worst, *b.worst);
  });
  return out;
}

std::string finding_text(const Finding& finding) {
  return cut((finding.score.empty() ? "" : finding.score + ": ") + finding.what, kTextColumns);
}

std::vector<std::string> shortened_notes(const std::vector<std::string>& notes) {
  std::vector<std::string> out;
  for (const std::string& note : notes) {
    if (out.size() == kMostNotes) {
      out.push_back(fmt::format("and {}", counted(notes.size() - kMostNotes, "more note")));
      break;
    }
    out.push_back(cut(note, 3 * kTextColumns));
  }
  return out;
}

Table methods_table(const GateReport& report, const std::string& sweep) {
  Table out{.title = cut(sweep, kTextColumns) + ": " + verdict(report),
            .headings = {"method", "cells", "regressions", "improvements", "new", "worst"}};
  std::vector<FindingGroup> methods = worst_first(report, &Finding::method);
  std::ranges::stable_sort(methods, std::ranges::greater(), &FindingGroup::regressions);
  for (const FindingGroup& each : methods) {
    if (out.lines.size() == kCommentMethods) break;
    const std::string& method = each.worst->method;
    const auto cells = report.cells_of_method.find(method);
    const std::string name = cut(method, kNameColumns);
    out.lines.push_back(
        {{name},
         {cells == report.cells_of_method.end() ? "0" : std::to_string(cells->second)},
         {std::to_string(each.regressions)},
         {std::to_string(each.improvements)},
         {std::to_string(each.added)},
         {each.regressions == 0 ? "" : cut(each.worst->cell, kNameColumns)}});
  }
  out.notes = {counts_text(report)};
  if (methods.size() > kCommentMethods) {
    out.notes.push_back(
        fmt::format("and {}", counted(methods.size() - kCommentMethods, "more method")));
  }
  for (const std::string& note : shortened_notes(report.notes)) out.notes.emplace_back(note);
  out.above = shortened_notes(report.above);
  return out;
}

Table cells_table(const GateReport& report) {
  const std::vector<FindingGroup> cells = worst_first(report, &Finding::cell);
  const std::size_t shown = std::min(cells.size(), kCommentCells);
  Table out{.title = fmt::format("The worst {} of {} cells with findings", shown, cells.size()),
            .headings = {"cell", "finding", "worst score", "more"}};
  for (const FindingGroup& each : std::span(cells).first(shown)) {
    const std::size_t more = each.all() - 1;
    out.lines.push_back({{cut(each.worst->cell, kNameColumns)},
                         {name(each.worst->kind)},
                         {finding_text(*each.worst)},
                         {more == 0 ? "" : std::to_string(more)}});
  }
  out.notes = {"more: further findings of the cell, all of which `check` prints"};
  return out;
}

}  // namespace

std::string comment(const GateReport& report, const std::string& sweep) {
  if (report.findings.size() > kCommentCells) {
    return markdown({methods_table(report, sweep), cells_table(report)});
  }
  GateReport brief = report;
  brief.notes = shortened_notes(report.notes);
  brief.above = shortened_notes(report.above);
  for (Finding& finding : brief.findings) {
    finding.cell = cut(finding.cell, kNameColumns);
    finding.score = cut(finding.score, kNameColumns);
    finding.what = cut(finding.what, 2 * kTextColumns);
  }
  return markdown(brief, cut(sweep, kTextColumns));
}

}  // namespace loopbench::harness
