/// Output of comparisons as text.
#pragma once

#include <string>
#include <vector>

#include "harness/answers/compare/verdict.hpp"
#include "harness/answers/tables/table.hpp"

namespace loopbench::harness {

inline constexpr std::size_t kLineWidth = 100;  ///< of texts [characters]

/// The sentence as title, a line per group, then cautions and legend as notes. Without columns
/// where they would show no more than the sentence, and with as many sequences as fit into lines of
/// `width` characters; 0: all.
Table verdict_table(const Verdict& verdict, std::size_t width = kLineWidth);

/// One line per method, the first place first: place (=: shares it, >: significantly worse),
/// median, typical change to the baseline with its interval, groups on which it is better and
/// worse, p. Best methods are marked. Notes: remarks.
Table table_view(const Comparison& comparison);

/// The verdict of the headline, its methods, and the sentences of other scores; at least one.
std::vector<Table> answer(const std::vector<Comparison>& comparisons);

/// One line per method of every comparison, numbers in full precision; missing values are empty.
std::string csv(const std::vector<Comparison>& comparisons);

/// Array with one object per comparison: its score, verdict (sentence,
/// groups, cautions, legend), remarks, methods, gaps.
/// `indent` below zero writes one line.
std::string json(const std::vector<Comparison>& comparisons, int indent = 2);

}  // namespace loopbench::harness
