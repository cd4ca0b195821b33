#include "harness/statistics/normal.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace loopbench {

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double normal_quantile(double p) {
  if (!(p >= 0.0 && p <= 1.0)) throw std::invalid_argument("a probability lies in [0, 1]");
  if (p == 0.0 || p == 1.0) return (p - 0.5) * std::numeric_limits<double>::infinity();
  if (p > 0.5) return -normal_quantile(1.0 - p);  // the lower tail keeps its digits
  // Halving needs no starting guess and no coefficients; it is asked for a few times a table.
  double low = -40.0;
  double high = 0.0;
  while (true) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) return middle;
    (normal_cdf(middle) < p ? low : high) = middle;
  }
}

}  // namespace loopbench
