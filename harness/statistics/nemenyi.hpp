/// Which average ranks differ: Nemenyi's test after Friedman's, as Demsar (JMLR 7, 2006) advises.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace loopbench {

/// Average ranks of k treatments over n blocks differ at level alpha when they are further apart
/// than this: q sqrt(k (k + 1) / (6 n)), q the studentized range's quantile over sqrt 2.
/// Throws std::invalid_argument.
double critical_difference(std::size_t treatments, std::size_t blocks, double alpha);

/// Indices of the treatments whose average ranks lie within `difference` of each other, best
/// first; only groups of two or more that no other contains. O(n log n).
std::vector<std::vector<std::size_t>> rank_groups(std::span<const double> average_ranks,
                                                  double difference);

}  // namespace loopbench
