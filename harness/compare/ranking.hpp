/// Which method is proven better than which: the one procedure behind verdicts, ranks and marks.
///
/// Every pair of methods is tested over groups by Wilcoxon's signed-rank test (zeros as Pratt has
/// them), a group on which a method fails more often being lost by the largest magnitude; Holm's
/// correction covers all pairs, so a best method that was picked by looking is covered too. A
/// method is proven better than another where that p is at most alpha, and the geometric mean ratio
/// over common runs agrees: it points the same way, by more than the relevant difference (failures
/// alone may decide between methods that are equal otherwise), with an interval that excludes 1,
/// and so does the order. Fewer groups than an interval needs (8) prove nothing. Where there is no
/// interval for another reason (equal ratios, failures), the ranks, the direction and the size of
/// the ratio decide.
#pragma once

#include <string>
#include <vector>

#include "harness/compare/levels.hpp"
#include "harness/compare/paired.hpp"
#include "harness/statistics/mean_interval.hpp"
#include "harness/statistics/ranks.hpp"

namespace loopbench::harness {

struct RankingOptions {
  double alpha = 0.05;          ///< chance of any false claim among all pairs
  double relevant = kRelevant;  ///< relative difference up to which methods are equal
};

struct Ranking {
  std::vector<std::size_t> order;        ///< best standing first (Levels::standing)
  std::vector<std::vector<bool>> beats;  ///< [a][b]: a is proven better than b
  std::vector<std::vector<bool>> equal;  ///< [a][b]: tied on every group
  std::vector<std::vector<double>> p;    ///< [a][b]: at most alpha exactly where one beats
  std::size_t pairs = 0;                 ///< tested: those that are not equal
  double least_p = 1.0;                  ///< that all groups of one sign reach, corrected; or 1
  /// Fewest with which a pair could be proven.
  std::size_t groups_needed = kFewestForInterval;

  /// Whether so many groups can prove anything about so many methods.
  bool can_prove(double alpha) const { return least_p <= alpha; }
  /// The first in order and those equal to it.
  std::vector<std::size_t> leaders() const;
  /// Whether the leaders beat every other method.
  bool is_best_proven() const;
  /// Ranks that the claims leave to a method: 1 + those that beat it, to all less those it beats.
  std::size_t lowest_rank(std::size_t method) const;
  std::size_t highest_rank(std::size_t method) const;
};

/// Deterministic. O(methods^2 * (runs + groups^3)) for exact tests.
Ranking rank_methods(const GroupedValues& values, const RankingOptions& options);

/// A text of letters for each method; two share a letter exactly where neither beats the other
/// (Piepho, Journal of Computational and Graphical Statistics 13, 2004). `a` holds the first in
/// order. Empty texts where that takes more than 100 letters.
std::vector<std::string> letters(const Ranking& ranking);

}  // namespace loopbench::harness
