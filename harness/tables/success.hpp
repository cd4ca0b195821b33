/// Success rates over runs.
#pragma once

#include <string>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/tables/table.hpp"

namespace loopbench::harness {

/// One line for each method: its runs (cells), those that succeeded, their share and its 95 %
/// interval. A run succeeds if the statistic of the first directed score over all axes is at most
/// `limit` (at least, if higher is better); failed and incomplete runs do not, and runs that a
/// method declines are left out. Throws InputError for an unknown statistic, or without such a
/// score. O(n log n).
///
/// Source of the interval: E. Wilson, Probable inference, the law of succession, and statistical
/// inference, JASA 22, 1927.
Table success_table(const std::vector<Record>& records, const std::string& statistic, double limit);

}  // namespace loopbench::harness
