/// Output of comparisons as text.
#pragma once

#include <string>
#include <vector>

#include "harness/compare/verdict.hpp"
#include "harness/tables/table.hpp"

namespace loopbench::harness {

/// The sentence as title, a line per group, then cautions and legend as notes. Without
/// columns where they would show no more than the sentence.
Table verdict_table(const Verdict& verdict);

/// One line per method, the first place first: median, typical ratio to the baseline with its
/// interval, wins, losses and ties against it, p, geometric mean ratio, and place (=: shares the
/// first one, >: significantly worse). Best methods are marked. Notes: remarks.
Table table_view(const Comparison& comparison);

/// One line per method of every comparison, numbers in full precision; missing values are empty.
std::string csv(const std::vector<Comparison>& comparisons);

/// Array with one object per comparison: its score, verdict (sentence,
/// groups, cautions, legend), remarks, methods, gaps.
/// `indent` below zero writes one line.
std::string json(const std::vector<Comparison>& comparisons, int indent = 2);

}  // namespace loopbench::harness
