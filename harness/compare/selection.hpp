/// The subset of a score's values on which all methods can be compared.
#pragma once

#include <string>
#include <vector>

#include "harness/compare/compare.hpp"

namespace loopbench::harness {

struct CommonRuns {
  std::vector<std::size_t> methods;  ///< indices into the observations: methods with any value
  std::vector<std::size_t> runs;     ///< likewise
  GroupedValues values;              ///< values of these methods and runs
};

/// Runs on which every ranked method has a value or failed, and at least one has a value, grouped
/// by `out.options.over`. Records kept and missing counts in `out`.
CommonRuns select_common(const Observations& all, Comparison& out);

/// "declined 1, failed 2": each reason with its count.
std::string counted(const std::vector<std::string>& reasons);

}  // namespace loopbench::harness
