/// Output of comparisons as text.
#pragma once

#include <string>
#include <vector>

#include "harness/compare/compare.hpp"
#include "harness/tables/table.hpp"

namespace loopbench::harness {

/// "ate rotation rmse, dense, loopbench".
std::string title(const Comparison& comparison);

/// One line per method, the leader first: median, typical ratio to the baseline with its interval,
/// wins, losses and ties against it, p, geometric mean ratio, and how far it is behind the leader
/// (~: not significantly). Best methods are marked. Notes: verdict, remarks.
Table table_view(const Comparison& comparison);

/// One line per method of every comparison, numbers in full precision; missing values are empty.
std::string csv(const std::vector<Comparison>& comparisons);

/// Array with one object per comparison: its score, verdict, remarks, methods, gaps.
/// `indent` below zero writes one line.
std::string json(const std::vector<Comparison>& comparisons, int indent = 2);

}  // namespace loopbench::harness
