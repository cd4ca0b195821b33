/// Comparison of two methods. Nothing here depends on a third one.
///
/// Paired runs (the same input for both): Wilcoxon's exact signed-rank test of the groups' log
/// ratios (zeros as in Pratt); a group counts with the median over its runs, on which a failure of
/// one method is a loss beyond all ratios. Independent runs of the same sequences: rank sums within
/// sequences, where a failure ranks last and all ties count against the better method. The typical
/// ratio is the Hodges-Lehmann estimate, and its interval inverts the test.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "harness/compare/levels.hpp"
#include "harness/compare/rank_sum.hpp"
#include "harness/compare/signed_rank.hpp"

namespace loopbench::harness {

/// p for the smallest of several equal tests (Sidak, 1967), and the level of each test for which
/// the corrected p is `alpha`. Methods that are exchangeable given the data and the baseline's
/// errors cannot exceed it (Kimball's inequality).
double corrected(double p, std::size_t tests);
double level_of_one(double alpha, std::size_t tests);

/// Mean of the finite differences of a sequence, with its standard error (infinite for one).
struct SequenceMean {
  std::size_t sequence = 0;
  double mean = 0.0;
  double error = 0.0;
};

struct Pair {
  /// Differences, the first method minus the second; negative: the first is better. +-kNoRatio: one
  /// method fails, or one error is zero. Paired: one per group with an observation of both, the
  /// median over its runs. Independent: one per pair of runs of a sequence.
  std::vector<double> values;
  std::vector<std::size_t> sequence;  ///< of each value
  std::vector<Stratum> strata;        ///< of independent runs: their numbers by sequence
  /// Mean over the groups (or sequences) of the mean over runs on which both have a value. Of log
  /// ratios, its exponential is the geometric mean ratio.
  std::optional<double> mean;
  bool has_zero = false;  ///< one error of some run is zero, which `mean` takes for 1e-12
  bool is_ratio = true;   ///< differences are logarithms of ratios
  std::size_t wins = 0;   ///< values for which the first is better
  std::size_t losses = 0;
  std::size_t ties = 0;
  double lead = 0.0;  ///< of the rank sums: positive if the first is ahead
  double p = 1.0;
  double least_p = 1.0;  ///< if all values had one sign

  bool has_difference() const { return wins + losses > 0; }
  /// By ranks, and by the mean if they are balanced.
  bool is_first_ahead() const;
  /// Whether the mean favours the other method than the ranks do, and it is not the case that the
  /// method that is behind fails on more groups than it wins.
  bool is_contradicted() const;
  /// Whether the corrected p is at most alpha and nothing contradicts it.
  bool is_significant(double alpha, std::size_t tests) const;

  /// Typical difference with the interval of level 1 - alpha; nullopt if there are too few values.
  /// It excludes 0 exactly if p <= alpha (an end can be 0 then). If every sequence has five groups
  /// or more, the sequences' own typical differences are taken out first: the interval is for more
  /// runs of these sequences.
  std::optional<Interval> typical(double alpha) const;

  /// Of each sequence that has finite values, by number of the sequence.
  std::vector<SequenceMean> by_sequence() const;
};

/// O(n log n), and O(n^3) up to 50 groups; independent runs: O(runs^2).
Pair compared(const Levels& levels, std::size_t first, std::size_t second);

}  // namespace loopbench::harness
