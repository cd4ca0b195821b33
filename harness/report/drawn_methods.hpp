/// Which methods figures show, and how.
#pragma once

#include <string>
#include <vector>

#include "harness/report/content.hpp"

namespace loopbench::harness {

/// The methods that `plot` and the report draw by default: the baseline and the best-ranked
/// methods, at most five. Methods whose medians differ by less than 3 % are not drawn twice, as
/// their curves coincide, unless only one would remain. Without a ranking the first methods of the
/// sweep.
std::vector<std::string> usual_methods(const ReportContent& content);

/// All methods, the baseline first, then in the order of the sweep. Their indices determine their
/// styles (curve_style()) in `plot` and in the report.
std::vector<std::string> style_order(const ReportContent& content);

}  // namespace loopbench::harness
