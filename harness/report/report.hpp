/// One HTML file that tells what a sweep found; opens offline, prints, needs nothing beside it.
#pragma once

#include <string>

#include "harness/report/content.hpp"

namespace loopbench {

/// Tables and verdicts are plain HTML; figures are drawn from embedded data by the page's scripts
/// (d3, embedded). Trajectories are thinned until all stays below `bytes`, first of later repeats.
/// Throws InputError naming the least size when that is not enough.
std::string report_html(const ReportContent& content, std::size_t bytes = 9'000'000);

}  // namespace loopbench
