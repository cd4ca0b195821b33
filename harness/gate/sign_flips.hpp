/// A joint permutation test of many paired comparisons on the same runs.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace loopbench::harness {

/// Paired differences of one comparison: the run index and the difference, positive: worse.
using RunDifferences = std::vector<std::pair<std::size_t, double>>;

/// For each comparison, the probability that the largest standardised signed-rank sum (one-sided,
/// Pratt's treatment of zeros) over all comparisons is at least its own, if the signs of all
/// differences of a run are flipped together (the maxT procedure of Westfall and Young, 1993).
/// Controls the family-wise error for any dependence between the comparisons of a run. A comparison
/// without a difference has probability 1. Exact up to 14 runs, otherwise from max(10^4, 100 /
/// `level`) draws with a fixed seed. `runs` exceeds every run index. O(flips * differences).
std::vector<double> sign_flip_test(const std::vector<RunDifferences>& comparisons,
                                   std::size_t runs,
                                   double level);

/// The smallest probability that a comparison over this many runs can reach.
double least_sign_flip_p(std::size_t runs);

}  // namespace loopbench::harness
