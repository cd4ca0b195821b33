/// Records computed from other records: gain over the baseline; time and pair counts as columns.
#pragma once

#include <string>
#include <vector>

#include "harness/model/record.hpp"

namespace loopbench {

/// For every `ate` translation record with a baseline record of the same sequence, repeat,
/// protocol and times: metric `gain`, unit %, each statistic 100 * (1 - value / baseline value).
/// Positive is better; the baseline itself gains 0. A statistic is not a number where the
/// baseline's is zero but for rounding, and the record is declined where that is its RMSE. Gains of
/// several runs are averaged by their ratios (see pivot.hpp). None when `baseline` is empty. O(n
/// log n).
std::vector<Record> gains(const std::vector<Record>& records, const std::string& baseline);

/// One record per cell, protocol and times: metric `time`, unit ms, every statistic the median wall
/// time.
std::vector<Record> run_times(const std::vector<Record>& records);

/// One record per cell, protocol and times: metric `pairs`, the pose pairs behind the scores.
std::vector<Record> pair_counts(const std::vector<Record>& records);

}  // namespace loopbench
