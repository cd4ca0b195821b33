#include "harness/execution/run/incomplete.hpp"

#include <fmt/format.h>

namespace loopbench::harness {

std::string incomplete_reason(const metrics::Coverage& coverage, double min_coverage) {
  if (coverage.least() >= min_coverage) return "";
  return fmt::format(
      "evaluated {} of {} poses over {:.1f} % of the reference's time, below {:.1f} %",
      coverage.pairs,
      coverage.possible,
      100.0 * coverage.span,
      100.0 * min_coverage);
}

}  // namespace loopbench::harness
