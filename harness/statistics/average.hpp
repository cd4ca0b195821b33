/// One number for many: means and quantiles. (The median is metrics/median.hpp.)
#pragma once

#include <span>

namespace loopbench {

/// Throws std::invalid_argument when empty.
double mean(std::span<const double> values);

/// exp of the mean logarithm: the average that suits ratios, since the mean of x and 1/x is 1.
/// Throws std::invalid_argument when empty or when a value is not positive.
double geometric_mean(std::span<const double> values);

/// With the divisor n - 1. Throws std::invalid_argument on fewer than two values.
double sample_deviation(std::span<const double> values);

/// Linear between order statistics (Hyndman and Fan 1996, type 7: the default of R and numpy).
/// `sorted` ascends; p in [0, 1]. Throws std::invalid_argument.
double quantile(std::span<const double> sorted, double p);

}  // namespace loopbench
