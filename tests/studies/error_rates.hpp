/// How often verdicts on synthetic records are wrong, and intervals miss.
#pragma once

#include "harness/compare/compare.hpp"
#include "tests/studies/synthetic_records.hpp"

namespace loopbench::synthetic {

using namespace metrics;

struct ErrorRates {
  double false_best = 0.0;    ///< a method is called best that is not
  double false_better = 0.0;  ///< any pair is ordered that is equal, or the other way round
  double found = 0.0;         ///< the truly best method is called best
  double marked_wrong = 0.0;  ///< a table marks a method as best that is not
};

/// Whether records are compared as drawn, or written to a store and read as the command `compare`
/// reads it.
enum class Through { memory, store };

/// Over `repeats` draws. Effects that are equal are true ties: none of them is best.
ErrorRates error_rates(const Truth& truth,
                       const Shape& shape,
                       int repeats,
                       std::uint64_t seed,
                       Through through = Through::memory);

struct IntervalCoverage {
  double covered = 0.0;   ///< share of the given intervals that hold the true ratio
  double declined = 0.0;  ///< share of comparisons without an interval
};

/// Of the interval of method 1 against the baseline.
IntervalCoverage coverage(const Truth& truth,
                          const Shape& shape,
                          int repeats,
                          std::uint64_t seed,
                          Through through = Through::memory);

}  // namespace loopbench::synthetic
