/// Error rates of verdicts and coverage of intervals on synthetic records.
#pragma once

#include <algorithm>

#include "harness/answers/compare/compare.hpp"
#include "tests/studies/synthetic_records.hpp"

namespace loopbench::synthetic {

using namespace metrics;

/// Shares of comparisons with a false statement of each family, judged by the truth.
struct ErrorRates {
  double baseline = 0.0;   ///< a method is wrongly better or worse than the baseline
  double best = 0.0;       ///< a truly best method is marked as worse, so also any wrong best
  double sequences = 0.0;  ///< a method is wrongly better or worse than the baseline on a sequence
  double failures = 0.0;   ///< a method is wrongly said to fail more often than the baseline
  double missed = 0.0;     ///< an interval does not hold the true ratio, of those with intervals
  double intervals = 0.0;  ///< comparisons with intervals of all methods
  double contradicted = 0.0;  ///< two statements contradict each other
  double claimed = 0.0;       ///< method 1 is shown to be below the baseline
  double found = 0.0;         ///< the truly best method is reported as best
  double holm = 0.0;          ///< it beats each rival with Holm's correction over the rivals
  double wilcoxon = 0.0;      ///< two methods differ by Wilcoxon's test; up to 20 runs

  double largest() const { return std::max({baseline, best, sequences, failures, missed}); }
};

/// Rates over `repeats` draws. Equal effects are true ties: none of them is best. The effect of a
/// method is the mean over the sequences; one with a larger effect or more failures than another is
/// truly worse.
ErrorRates error_rates(const Truth& truth, const Shape& shape, int repeats, std::uint64_t seed);

struct IntervalCoverage {
  double covered = 0.0;   ///< share of the intervals that contain the true ratio
  double declined = 0.0;  ///< share of comparisons without an interval
};

/// Share of draws in which the intervals of all methods hold their typical ratio to the baseline;
/// of methods that differ by sequence, the mean over the sequences.
IntervalCoverage coverage(const Truth& truth, const Shape& shape, int repeats, std::uint64_t seed);

}  // namespace loopbench::synthetic
