/// One number for many: means. (The median is metrics/numerics/median.hpp.)
#pragma once

#include <span>

namespace loopbench {

/// Throws std::invalid_argument when empty.
double mean(std::span<const double> values);

/// With the divisor n - 1. Throws std::invalid_argument on fewer than two values.
double sample_deviation(std::span<const double> values);

}  // namespace loopbench
