/// Error rates of verdicts and coverage of intervals on synthetic records.
#pragma once

#include "harness/compare/compare.hpp"
#include "tests/studies/synthetic_records.hpp"

namespace loopbench::synthetic {

using namespace metrics;

struct ErrorRates {
  double false_best = 0.0;    ///< a method is reported as best that is not
  double false_better = 0.0;  ///< a method is wrongly better or worse than the baseline
  double found = 0.0;         ///< the truly best method is reported as best
};

/// Rates over `repeats` draws. Equal effects are true ties: none of them is best.
ErrorRates error_rates(const Truth& truth, const Shape& shape, int repeats, std::uint64_t seed);

struct IntervalCoverage {
  double covered = 0.0;   ///< share of the intervals that contain the true ratio
  double declined = 0.0;  ///< share of comparisons without an interval
};

/// Share of draws in which the intervals of all methods hold their typical ratio to the baseline;
/// of methods that differ by sequence, the mean over the sequences.
IntervalCoverage coverage(const Truth& truth, const Shape& shape, int repeats, std::uint64_t seed);

/// Share of draws in which method 1 is significantly better than the baseline.
double power(const Truth& truth, const Shape& shape, int repeats, std::uint64_t seed);

}  // namespace loopbench::synthetic
