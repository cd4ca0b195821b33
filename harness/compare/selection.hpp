/// The part of one score's values that all methods can be compared on.
#pragma once

#include <string>
#include <vector>

#include "harness/compare/compare.hpp"

namespace loopbench {

struct Selection {
  std::vector<std::size_t> methods;  ///< places in the observations: those with a value anywhere
  std::vector<std::size_t> runs;     ///< likewise
  GroupedValues values;              ///< of these
};

/// Runs on which every ranked method has a value or failed, and one has a value, with their groups
/// as `out.options.over` asks. Counts what is kept and what is missing into `out`.
Selection select_common(const Observations& all, Comparison& out);

/// "declined 1, failed 2": each reason with its number.
std::string counted(const std::vector<std::string>& reasons);

}  // namespace loopbench
