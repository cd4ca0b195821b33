/// Static HTML sections of a report.
#pragma once

#include <string>

#include "harness/report/report.hpp"
#include "harness/tables/table.hpp"

namespace loopbench::harness {

/// Summary: number of cells by status, and the headline verdict in large type.
std::string summary_html(const ReportContent& content);

/// Verdict for every score.
std::string verdicts_html(const ReportContent& content);

/// The headline comparison in full.
std::string comparison_html(const ReportContent& content);

/// Methods by scores, a table for each sequence, times and protocol.
std::string scores_html(const ReportContent& content);

/// Failed cells and undefined scores, by reason.
std::string failures_html(const ReportContent& content);

/// Costs, and values reported by the methods.
std::string costs_html(const ReportContent& content);

/// One row per method: wall and CPU time, memory, iterations. Medians over its finished cells,
/// maximum for memory. No rows for results of files (`eval --store`), which have no times.
Table costs(const std::vector<CellRecord>& cells);

/// Protocols, provenance, input files, config.
std::string provenance_html(const ReportContent& content);

}  // namespace loopbench::harness
