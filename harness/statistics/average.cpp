#include "harness/statistics/average.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace loopbench {

double mean(std::span<const double> values) {
  if (values.empty()) throw std::invalid_argument("the mean of nothing");
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double geometric_mean(std::span<const double> values) {
  if (values.empty()) throw std::invalid_argument("the geometric mean of nothing");
  double sum = 0.0;
  for (const double value : values) {
    if (!(value > 0.0)) throw std::invalid_argument("a geometric mean needs positive values");
    sum += std::log(value);
  }
  return std::exp(sum / static_cast<double>(values.size()));
}

double sample_deviation(std::span<const double> values) {
  if (values.size() < 2) throw std::invalid_argument("a deviation needs two values");
  const double middle = mean(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - middle) * (value - middle);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

double quantile(std::span<const double> sorted, double p) {
  if (sorted.empty() || !(p >= 0.0 && p <= 1.0)) {
    throw std::invalid_argument("a quantile needs values and a probability");
  }
  const double place = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double share = place - static_cast<double>(below);
  return sorted[below] + share * (sorted[above] - sorted[below]);
}

}  // namespace loopbench
