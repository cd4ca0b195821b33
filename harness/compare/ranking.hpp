/// Pairwise significance of methods: the procedure behind verdicts, ranks and marks.
///
/// Every pair of methods is tested over groups by Wilcoxon's signed-rank test (zeros as in Pratt);
/// a group on which one method fails more often counts as its loss, with the largest magnitude.
/// Holm's correction covers all pairs, including that of a best method selected from the results. A
/// method is proven better than another if the corrected p is at most alpha and the geometric mean
/// ratio over common runs agrees: it has the same sign, exceeds the relevant difference (failures
/// alone can decide between methods that are otherwise equal), and its interval excludes 1 even
/// if it misses the ratio as often as for the worst of usual distributions. Errors of other methods
/// do not matter: they change a pair's p only through the number of pairs.
/// With fewer groups than an interval needs (8), nothing is proven. If there is no interval for
/// another reason (equal ratios, failures), the ranks and the direction and size of the ratio
/// decide; `compare` remarks that groups with equal ratios can be copies.
#pragma once

#include <string>
#include <vector>

#include "harness/compare/levels.hpp"
#include "harness/compare/paired.hpp"
#include "harness/statistics/mean_interval.hpp"
#include "harness/statistics/ranks.hpp"

namespace loopbench::harness {

struct RankingOptions {
  double alpha = 0.05;          ///< probability of any false claim among all pairs
  double relevant = kRelevant;  ///< relative difference up to which methods are equal
};

struct Ranking {
  std::vector<std::size_t> order;  ///< by Levels::standing, but no method before one that beats it
  std::vector<std::vector<bool>> beats;  ///< [a][b]: a is proven better than b
  std::vector<std::vector<bool>> equal;  ///< [a][b]: tied on every group
  std::vector<std::vector<double>> p;    ///< [a][b]: at most alpha exactly if one beats the other
  std::size_t pairs = 0;                 ///< number of tested pairs, which are not equal
  double least_p = 1.0;                  ///< corrected p if all groups have one sign; or 1
  /// Minimum number of groups for a significant pair.
  std::size_t groups_needed = kFewestForInterval;

  /// Whether a pair can be significant with this number of groups and methods.
  bool can_prove(double alpha) const { return least_p <= alpha; }
  /// The first in order and those equal to it.
  std::vector<std::size_t> leaders() const;
  /// Whether the leaders beat every other method.
  bool is_best_proven() const;
  /// Range of ranks given the significant pairs: 1 + the number of methods that beat it, to the
  /// number of methods minus those that it beats.
  std::size_t lowest_rank(std::size_t method) const;
  std::size_t highest_rank(std::size_t method) const;
};

/// Deterministic. O(methods^2 * (runs + groups^3)) for exact tests.
Ranking rank_methods(const GroupedValues& values, const RankingOptions& options);

/// Whether some method is not significantly worse than the first even without a correction,
/// although the number of groups would suffice: then no best method is proven. Few tests instead of
/// all pairs; false if that is unknown.
bool is_surely_unproven(const GroupedValues& values, const RankingOptions& options);

/// Letters for each method; two methods share a letter exactly if neither beats the other (Piepho,
/// Journal of Computational and Graphical Statistics 13, 2004). The first in order has `a`. Empty
/// strings if more than 100 letters are needed.
std::vector<std::string> letters(const Ranking& ranking);

}  // namespace loopbench::harness
