/// Scores that a metric failed to give.
#pragma once

#include <vector>

#include "harness/model/record.hpp"

namespace loopbench {

/// A metric that throws leaves one record without relation and axis, since it gives no scores.
/// Replaces each such record by one for every score that the metric gives under the same protocol
/// at the same times: to other methods on the same run, or else on any run. Then a failure belongs
/// to the scores that it is missing from. Records of metrics that give no score at all stay as they
/// are. O(n log n).
void name_failed_scores(std::vector<Record>& records);

}  // namespace loopbench
