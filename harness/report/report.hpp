/// HTML report of a sweep in one self-contained file.
#pragma once

#include <string>

#include "harness/report/content.hpp"

namespace loopbench::harness {

/// Tables and verdicts are plain HTML; figures are drawn from embedded data by the page's scripts
/// (d3, embedded). Until the file is smaller than `bytes`, trajectories are thinned, later repeats
/// first; then later sequences are left out of tables and figures, which the summary says. Throws
/// InputError naming the minimum size if one sequence is too large.
std::string report_html(ReportContent content, std::size_t bytes = kReportBytes);

}  // namespace loopbench::harness
