/// Tails of the normal and of Student's distribution.
#pragma once

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

namespace loopbench::harness {

/// P(Z <= z) of the standard normal distribution, to a few ulp in both tails.
inline double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

/// P(|T| >= t) for any real number of degrees of freedom, by the continued fraction of the
/// incomplete beta function (Abramowitz and Stegun, 26.5.8). O(1).
inline double student_two_sided(double t, double degrees) {
  const double square = t * t;
  double a = 0.5 * degrees;
  double b = 0.5;
  double x = degrees / (degrees + square);
  const bool is_swapped = x > (a + 1.0) / (a + b + 2.0);
  const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                a * std::log(x) + b * std::log1p(-x));
  if (square == 0.0) return 1.0;
  if (is_swapped) {
    std::swap(a, b);
    x = square / (degrees + square);
  }
  // Evaluated from the end, because convergence is fast on this side.
  double fraction = 1.0;
  for (int m = 200; m > 0; --m) {
    const double k = m;
    const double even = k * (b - k) * x / ((a + 2.0 * k - 1.0) * (a + 2.0 * k));
    const double odd =
        -(a + k - 1.0) * (a + b + k - 1.0) * x / ((a + 2.0 * k - 2.0) * (a + 2.0 * k - 1.0));
    fraction = 1.0 + odd / (1.0 + even / fraction);
  }
  const double tail = front / (a * fraction);
  return is_swapped ? 1.0 - tail : tail;
}

}  // namespace loopbench::harness
