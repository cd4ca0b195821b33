/// Mean and standard deviation. (The median is in median.hpp.)
#pragma once

#include <span>

namespace loopbench::metrics {

/// Arithmetic mean. Throws std::invalid_argument for an empty list.
double mean(std::span<const double> values);

/// Standard deviation with divisor n - 1. Throws std::invalid_argument for fewer than two values.
double sample_deviation(std::span<const double> values);

}  // namespace loopbench::metrics
