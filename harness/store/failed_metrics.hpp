/// Expansion of failed metrics into their scores.
#pragma once

#include <vector>

#include "harness/model/record.hpp"

namespace loopbench::harness {

/// A metric that throws leaves one record without relation and axis. Replaces each such record by
/// one for every score of the metric under the same protocol and times: of other methods on the
/// same run, or otherwise of any run. The failure is then assigned to the missing scores. Records
/// of metrics without any score remain unchanged. O(n log n).
void expand_failed_metrics(std::vector<Record>& records);

}  // namespace loopbench::harness
