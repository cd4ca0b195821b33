/// Static HTML sections of a report.
#pragma once

#include <string>

#include "harness/report/content.hpp"

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

/// Costs, values reported by the methods, scaling with size, accuracy against time.
std::string costs_html(const ReportContent& content);

/// Protocols, provenance, input files, config.
std::string provenance_html(const ReportContent& content);

}  // namespace loopbench::harness
