/// One table with the result of a whole sweep.
#pragma once

#include <string>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/tables/table.hpp"

namespace loopbench::harness {

struct SummaryOptions {
  std::string baseline;           ///< method that gain is relative to; empty: no gain, no verdicts
  std::string value = "rmse";     ///< statistic
  std::vector<std::string> show;  ///< preferred scores by their short names; empty: in stored order
};

/// Methods by sequences for one score, the first that has a direction, dense if the sweep has dense
/// times, under the first protocol. Further columns: mean rank over runs (1 is best; a failure
/// ranks below all values), gain and time. Rows are sorted by mean rank; with more than twelve
/// sequences their columns are left out, with more than thirty methods the last ones. The notes
/// contain one verdict per score, at most five, or one if the runs are too few to prove anything.
/// The records are those of `all_records`. Throws InputError for an unknown statistic. Without any
/// score the table has no lines. O(n log n) plus the cost of `compare`.
Table summary(const std::vector<Record>& records, const SummaryOptions& options);

}  // namespace loopbench::harness
