/// Comparison of two methods, group by group. Nothing here depends on a third one.
///
/// The test is Wilcoxon's exact signed-rank test of the groups' log ratios (zeros as in Pratt); a
/// group counts with the median over its runs, on which a failure of one method is a loss beyond
/// all ratios. The typical ratio is the Hodges-Lehmann estimate, and its interval inverts the test.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "harness/compare/levels.hpp"
#include "harness/statistics/signed_rank.hpp"
#include "harness/statistics/typical_difference.hpp"

namespace loopbench::harness {

struct Pair {
  /// One per group with an observation of both: median over its runs of the difference, the first
  /// method minus the second; negative: the first is better. +-kBeyond: one method fails, or one
  /// error is zero, on most of them.
  std::vector<double> values;
  std::vector<std::size_t> sequence;  ///< of each value
  /// Mean over the groups of the mean over runs on which both have a value. Of log ratios, its
  /// exponential is the geometric mean ratio.
  std::optional<double> mean;
  bool has_zero = false;  ///< one error of some run is zero, which `mean` takes for 1e-12
  bool is_ratio = true;   ///< differences are logarithms of ratios
  std::size_t wins = 0;   ///< groups on which the first is better
  std::size_t losses = 0;
  std::size_t ties = 0;
  SignedRank ranks;

  double p() const { return ranks.p; }
  /// By ranks, and by the mean if they are balanced.
  bool is_first_ahead() const;
  /// Whether the mean favours the other method than the ranks do, and it is not the case that the
  /// method that is behind fails on more groups than it wins.
  bool is_contradicted() const;
  /// Whether p, multiplied by the number of tests, is at most alpha and nothing contradicts it.
  bool is_significant(double alpha, std::size_t tests) const;

  /// Typical difference with the interval of level 1 - alpha; nullopt if there are too few values.
  /// It excludes 0 exactly if p <= alpha (an end can be 0 then). If every sequence has five values
  /// or more, the sequences' own typical differences are taken out first: the interval is for more
  /// runs of these sequences.
  std::optional<Interval> typical(double alpha) const;

  /// Standard deviation of the finite values; if every sequence has several, about their means.
  std::optional<double> deviation() const;

  /// Mean of the finite values of each sequence that has one, by number of the sequence.
  std::vector<std::pair<std::size_t, double>> by_sequence() const;
};

/// O(n log n), and O(n^3) up to 50 groups.
Pair compared(const Levels& levels, std::size_t first, std::size_t second);

}  // namespace loopbench::harness
