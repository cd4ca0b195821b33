/// Comparison of two methods. Nothing here depends on a third one.
///
/// An observation of paired runs (the same input for both) is the median log ratio over the runs of
/// a group; independent runs of the same sequences are two samples. Only runs that both methods
/// solved have a ratio; that one method fails more often is tested on its own.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "harness/answers/compare/levels.hpp"
#include "harness/answers/compare/randomization.hpp"

namespace loopbench::harness {

/// p for the smallest of several equal tests (Sidak, 1967), and the level of each test for which
/// the corrected p is `alpha`. Methods that are exchangeable given the data and the baseline's
/// errors cannot exceed it (Kimball's inequality).
double corrected(double p, std::size_t tests);
double level_of_one(double alpha, std::size_t tests);

struct Pair {
  std::map<std::size_t, Stratum> by_sequence;  ///< by number of the sequence
  /// Mean over the groups (or sequences) of the mean over runs on which both have a value. Of log
  /// ratios, its exponential is the geometric mean ratio.
  std::optional<double> mean;
  bool has_zero = false;  ///< one error of some run is zero, which counts as 1e-12 of the other
  bool is_ratio = true;   ///< differences are logarithms of ratios
  bool is_paired = true;
  std::size_t groups = 0;  ///< on which both have a value; of independent runs, pairs of them
  std::size_t wins = 0;    ///< of these, the first is better
  std::size_t losses = 0;
  std::size_t ties = 0;
  std::size_t runs = 0;          ///< on which both have a value; independent runs: of both
  std::size_t first_fails = 0;   ///< runs on which only the first fails; independent runs: it fails
  std::size_t second_fails = 0;  ///< likewise
  std::vector<Stratum> failures = {};  ///< 1: the first fails, -1: the second

  bool has_difference() const { return wins + losses > 0; }

  /// Whether the sequences are strata: several with two groups or more on average. Otherwise the
  /// sequences, or the groups of one, are the sample.
  bool has_strata() const;

  /// The test of the typical difference: negative if the first is better.
  RandomizationTest test() const;

  /// p of the test that both fail equally often; 1 without failures.
  double failure_p() const;

  bool first_fails_more() const;

  /// Whether the first (or the second) method fails on a run that the other solved; of independent
  /// runs, whether it fails more often.
  bool fails_beside(bool is_first) const;
};

/// O(n log n); independent runs: O(runs^2).
Pair compared(const Levels& levels, std::size_t first, std::size_t second);

}  // namespace loopbench::harness
