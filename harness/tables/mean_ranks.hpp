/// Mean ranks of methods over runs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/model/record.hpp"

namespace loopbench::harness {

/// Mean over runs of each method's rank among the methods that ran there: 1 for the best, ties
/// share the mean of their ranks, methods that failed share the ranks after the last value. Methods
/// that use the reference are not ranked. `records` are those of one score, and of cells without
/// scores. Throws InputError for an unknown statistic `value`. O(n log n).
std::map<std::string, double> mean_ranks(const std::vector<Record>& records,
                                         const std::string& value);

}  // namespace loopbench::harness
