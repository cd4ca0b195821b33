/// Mean and standard deviation. (The median is in median.hpp.)
#pragma once

#include <cmath>
#include <span>
#include <stdexcept>

namespace loopbench::metrics {

/// Arithmetic mean. Throws std::invalid_argument for an empty list.
inline double mean(std::span<const double> values) {
  if (values.empty()) throw std::invalid_argument("mean of an empty list");
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Standard deviation with divisor n - 1. Throws std::invalid_argument for fewer than two values.
inline double sample_deviation(std::span<const double> values) {
  if (values.size() < 2) throw std::invalid_argument("standard deviation of fewer than two values");
  const double middle = mean(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - middle) * (value - middle);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

}  // namespace loopbench::metrics
