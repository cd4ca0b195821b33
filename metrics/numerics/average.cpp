#include "metrics/numerics/average.hpp"

#include <cmath>
#include <stdexcept>

namespace loopbench::metrics {

double mean(std::span<const double> values) {
  if (values.empty()) throw std::invalid_argument("mean of an empty list");
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double sample_deviation(std::span<const double> values) {
  if (values.size() < 2) throw std::invalid_argument("standard deviation of fewer than two values");
  const double middle = mean(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - middle) * (value - middle);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

}  // namespace loopbench::metrics
