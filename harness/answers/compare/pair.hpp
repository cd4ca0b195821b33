/// Comparison of two methods. Nothing here depends on a third one.
///
/// Paired runs (the same input for both): Wilcoxon's exact signed-rank test of the groups' log
/// ratios (zeros as in Pratt); a group counts with the median over its runs, on which a failure of
/// one method is a loss beyond all ratios. Independent runs of the same sequences: rank sums within
/// sequences, where a failure ranks last and all ties count against the better method.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "harness/answers/compare/levels.hpp"
#include "harness/answers/compare/rank_sum.hpp"
#include "harness/answers/compare/signed_rank.hpp"

namespace loopbench::harness {

/// p for the smallest of several equal tests (Sidak, 1967), and the level of each test for which
/// the corrected p is `alpha`. Methods that are exchangeable given the data and the baseline's
/// errors cannot exceed it (Kimball's inequality).
double corrected(double p, std::size_t tests);
double level_of_one(double alpha, std::size_t tests);

/// Differences of two methods, on all sequences or on one.
struct Sample {
  /// The first method minus the second; negative: the first is better. +-kNoRatio: one method
  /// fails, or one error is zero. Paired: one per group with an observation of both, the median
  /// over its runs. Independent: one per pair of runs of a sequence.
  std::vector<double> values;
  std::vector<Stratum> strata;  ///< of independent runs: their numbers by sequence

  /// Hodges-Lehmann estimate of the typical difference; of independent runs the median.
  double middle() const;

  /// The differences that the test does not reject at level alpha, without looking at its p;
  /// nullopt if there are too few values.
  std::optional<Interval> interval(double alpha) const;
};

struct TestResult {
  double lead = 0.0;  ///< of the rank sums: positive if the first is ahead
  double p = 1.0;
  double least_p = 1.0;  ///< if all values had one sign
};

TestResult tested(const Sample& sample);

struct Pair : Sample, TestResult {
  std::map<std::size_t, Sample> by_sequence;  ///< by number of the sequence
  /// Mean over the groups (or sequences) of the mean over runs on which both have a value. Of log
  /// ratios, its exponential is the geometric mean ratio.
  std::optional<double> mean;
  bool has_zero = false;  ///< one error of some run is zero, which `mean` takes for 1e-12
  bool is_ratio = true;   ///< differences are logarithms of ratios
  std::size_t wins = 0;   ///< values for which the first is better
  std::size_t losses = 0;
  std::size_t ties = 0;

  bool has_difference() const { return wins + losses > 0; }
  /// By ranks, and by the mean if they are balanced.
  bool is_first_ahead() const;

  /// Whether each sequence counts once: several sequences of six groups or more.
  bool is_of_sequences() const;

  /// The typical difference: of sequences that count once, the mean of theirs.
  double typical() const;

  /// Whether the typical or the mean difference favours the other method than the ranks do, and it
  /// is not the case that the method that is behind fails on more groups than it wins.
  bool is_contradicted() const;

  /// Whether one sequence shows that the first is better, another that it is worse: p <= 0.05 over
  /// the number of sequences.
  bool is_divided() const;

  /// Whether p is at most `level`, nothing contradicts it, and sequences are not divided.
  bool is_significant(double level) const;

  /// typical() with the interval of level 1 - alpha; nullopt if a sequence has too few values, or
  /// p <= alpha contradicts it. It excludes 0 exactly if p <= alpha (an end can be 0 then). The
  /// interval of a mean over sequences combines their own ones by recovered variances (Zou and
  /// Donner, 2008), because sequences differ in scatter: the claim is about more runs of these
  /// sequences.
  std::optional<Interval> typical_interval(double alpha) const;
};

/// O(n log n), and O(n^3) up to 50 groups; independent runs: O(runs^2).
Pair compared(const Levels& levels, std::size_t first, std::size_t second);

}  // namespace loopbench::harness
