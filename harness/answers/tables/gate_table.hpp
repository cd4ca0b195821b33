/// Reports of the gate as text.
#pragma once

#include <fmt/format.h>

#include <map>
#include <string>

#include "harness/answers/gate/gate.hpp"
#include "harness/answers/tables/table.hpp"
#include "harness/sweep/text/counted.hpp"

namespace loopbench::harness {

inline const char* name(Finding::Kind kind) {
  if (kind == Finding::Kind::regression) return "regression";
  return kind == Finding::Kind::improvement ? "improvement" : "new";
}

inline std::string xml(const std::string& text) {
  std::string out;
  for (const char c : one_line(text)) {  // XML 1.0 does not allow control characters
    if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '&') {
      out += "&amp;";
    } else if (c == '"') {
      out += "&quot;";
    } else {
      out += c;
    }
  }
  return out;
}

inline std::string test_case(const std::string& sweep,
                             const std::string& name,
                             const std::vector<const Finding*>& regressions,
                             const std::string& why_failed) {
  std::string out = fmt::format("  <testcase classname=\"{}\" name=\"{}\"", xml(sweep), xml(name));
  if (regressions.empty() && why_failed.empty()) return out + "/>\n";
  std::string all = why_failed;
  for (const Finding* finding : regressions) {
    all += (all.empty() ? "" : "; ") + (finding->score.empty() ? "" : finding->score + ": ") +
           finding->what;
  }
  return out + fmt::format(
                   ">\n    <failure message=\"{}\">{}</failure>\n  </testcase>\n",
                   xml(why_failed.empty() ? counted(regressions.size(), "regression") : why_failed),
                   xml(all));
}

/// Verdict. What passes has only failures that the baseline has, too.
inline std::string verdict(const GateReport& report) {
  if (!report.passes()) return "FAILED";
  const std::size_t failed = report.failed.size();
  if (failed == 0) return "passed";
  return fmt::format("passed; {} as in the baseline",
                     failed == 1 ? "1 cell fails" : fmt::format("{} cells fail", failed));
}

/// "1 regression, 0 improvements, 0 new cells in 16 cells and 16 scores".
inline std::string counts_text(const GateReport& report) {
  return fmt::format("{}, {}, {} in {} and {}",
                     counted(report.count(Finding::Kind::regression), "regression"),
                     counted(report.count(Finding::Kind::improvement), "improvement"),
                     counted(report.count(Finding::Kind::added), "new cell"),
                     counted(report.cells, "cell"),
                     counted(report.scores, "score"));
}

/// Verdict, counts, notes and table of findings.
inline std::string markdown(const GateReport& report, const std::string& sweep) {
  Table out{sweep + ": " + verdict(report),
            {"cell", "score", "finding", "what"},
            {},
            {counts_text(report)}};
  for (const std::string& note : report.notes) out.notes.push_back(note);
  out.above = report.above;
  for (const Finding& finding : report.findings) {
    out.lines.push_back({{finding.cell}, {finding.score}, {name(finding.kind)}, {finding.what}});
  }
  if (out.lines.empty()) out.headings.clear();
  return markdown(out);
}

/// JUnit test suite with one case per cell of the baseline, failed if the cell failed, then or now,
/// with its reason, or has a regression. Escaped for XML 1.0.
inline std::string junit(const GateReport& report, const std::string& sweep) {
  std::map<std::string, std::vector<const Finding*>> regressions;
  for (const Finding& finding : report.findings) {
    if (finding.kind == Finding::Kind::regression) regressions[finding.cell].push_back(&finding);
  }
  std::string notes;
  for (const std::string& line : report.above) notes += "note: " + line + "\n";
  std::size_t failures = 0;
  std::string cases;
  for (const std::string& cell : report.names) {
    const auto failed = report.failed.find(cell);
    const std::string why = failed == report.failed.end() ? "" : failed->second;
    if (!why.empty() || !regressions[cell].empty()) ++failures;
    cases += test_case(sweep, cell, regressions[cell], why);
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\">\n{}{}</testsuite>\n",
      xml("loopbench check " + sweep),
      report.names.size(),
      failures,
      cases,
      notes.empty() ? "" : "<system-out>" + xml(notes) + "</system-out>\n");
}

}  // namespace loopbench::harness
