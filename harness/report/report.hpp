/// HTML report of a sweep in one self-contained file.
#pragma once

#include <string>

#include "harness/report/content.hpp"

namespace loopbench::harness {

/// Tables and verdicts are plain HTML; figures are drawn from embedded data by the page's scripts
/// (d3, embedded). Trajectories are thinned until the file is smaller than `bytes`, later repeats
/// first. Throws InputError naming the minimum size if that is not possible.
std::string report_html(const ReportContent& content, std::size_t bytes = 9'000'000);

}  // namespace loopbench::harness
