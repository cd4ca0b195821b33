#include "harness/statistics/chi_square.hpp"

#include <cmath>
#include <stdexcept>

namespace loopbench {

double chi_square_tail(double x, int degrees) {
  if (degrees < 1 || std::isnan(x)) {
    throw std::invalid_argument("chi-square needs a number and at least one degree of freedom");
  }
  if (x <= 0.0) return 1.0;
  const bool is_odd = degrees % 2 == 1;
  double tail = is_odd ? std::erfc(std::sqrt(0.5 * x)) : std::exp(-0.5 * x);
  for (int d = is_odd ? 3 : 4; d <= degrees; d += 2) {
    const double half = 0.5 * d;
    tail += std::exp((half - 1.0) * std::log(0.5 * x) - 0.5 * x - std::lgamma(half));
  }
  return std::fmin(tail, 1.0);
}

}  // namespace loopbench
