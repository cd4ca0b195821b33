/// The subset of a score's values on which methods can be compared.
#pragma once

#include <string>
#include <vector>

#include "harness/compare/compare.hpp"

namespace loopbench::harness {

struct KeptRuns {
  std::vector<std::size_t> methods;    ///< indices into the observations: methods with any value
  std::vector<std::size_t> runs;       ///< likewise
  GroupedValues values;                ///< values of these methods and runs
  std::vector<std::string> sequences;  ///< names by GroupedValues::sequence
};

/// Runs on which two ranked methods have a value or failed (one, if runs are independent), and at
/// least one has a value, grouped by `out.options.over`. Records counts in `out`.
KeptRuns select_runs(const Observations& all, Comparison& out);

/// "declined 1, failed 2": each reason with its count.
std::string counted(const std::vector<std::string>& reasons);

}  // namespace loopbench::harness
