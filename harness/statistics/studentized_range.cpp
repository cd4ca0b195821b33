#include "harness/statistics/studentized_range.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "harness/statistics/normal.hpp"

namespace loopbench {

double range_cdf(double q, int k) {
  if (k < 2 || std::isnan(q)) throw std::invalid_argument("a range needs two draws");
  if (q <= 0.0) return 0.0;
  // The smallest draw at z, the k - 1 others within q above it. The trapezoid rule converges
  // faster than any power of the step on an integrand that vanishes at both ends.
  const double step = 1.0 / 64.0;
  double sum = 0.0;
  for (int i = -64 * 9; i <= 64 * 9; ++i) {
    const double z = step * i;
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
    sum += density * std::pow(normal_cdf(z + q) - normal_cdf(z), k - 1);
  }
  return std::fmin(1.0, k * step * sum);
}

double range_quantile(double p, int k) {
  if (!(p > 0.0 && p < 1.0)) throw std::invalid_argument("a probability lies within (0, 1)");
  double low = 0.0;
  double high = 50.0;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (range_cdf(middle, k) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace loopbench
