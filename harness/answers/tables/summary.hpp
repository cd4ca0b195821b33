/// The result of a whole sweep.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "harness/answers/tables/table.hpp"
#include "harness/sweep/model/record.hpp"

namespace loopbench::harness {

struct SummaryOptions {
  std::string baseline;           ///< of the verdict; empty: none
  std::string value = "rmse";     ///< statistic
  std::vector<std::string> show;  ///< preferred scores by their short names; empty: in stored order
};

/// A table of methods, and the verdict, which is left out without the baseline. The score is the
/// first that has a direction, dense if the sweep has dense times, under the first protocol: in
/// translation and rotation, beside the first relative error and the time of the processor, means
/// over the runs. At most sixteen methods, in the order of the verdict, the baseline among them.
/// The records are those of `all_records`. Throws InputError for an unknown statistic. Without any
/// score there are no tables. `stated`, if given, receives the reasons for missing values that the
/// tables state or count. O(n log n) plus the cost of `compare`.
std::vector<Table> summary(const std::vector<Record>& records,
                           const SummaryOptions& options,
                           std::set<std::string>* stated = nullptr);

}  // namespace loopbench::harness
