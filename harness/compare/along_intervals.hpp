/// Intervals for comparisons with too few runs to resample the runs themselves.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/compare/compare.hpp"

namespace loopbench {

/// Position errors along one run [m], stamps ascending.
struct StampedErrors {
  std::vector<double> stamps;
  std::vector<double> errors;
};

/// Of a method on a run (as Comparison::runs names it); empty where none were kept.
using ErrorsOf = std::function<StampedErrors(const std::string& method, const std::string& run)>;

/// Where the comparison is of an ATE's RMSE over fewer than kFewestForInterval runs, gives every
/// method the interval of `ratio_along_runs` around its ratio, from poses that it and the baseline
/// share by stamp. Leaves it as it is where errors are missing.
void add_intervals_along_runs(Comparison& comparison, const ErrorsOf& errors_of);

}  // namespace loopbench
