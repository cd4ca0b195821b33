/// One HTML file that tells what a sweep found; opens offline, prints, needs nothing beside it.
#pragma once

#include <string>

#include "harness/report/content.hpp"

namespace loopbench {

/// Tables and verdicts are plain HTML; figures are drawn from embedded data by the page's scripts
/// (d3, embedded). `trace_bytes` is what the drawn trajectories may take of it.
std::string report_html(const ReportContent& content, std::size_t trace_bytes = 5'000'000);

}  // namespace loopbench
