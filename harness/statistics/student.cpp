#include "harness/statistics/student.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace loopbench::harness {

double student_p(double t, std::size_t freedom) {
  const auto nu = static_cast<double>(freedom);
  const double angle = std::atan(std::abs(t) / std::sqrt(nu));
  const double sine = std::sin(angle);
  const double cosine = std::cos(angle);
  const bool is_odd = freedom % 2 == 1;
  double term = is_odd ? cosine : 1.0;
  double sum = freedom == 1 ? 0.0 : term;
  for (std::size_t k = is_odd ? 3 : 2; k + 2 <= freedom; k += 2) {
    term *= cosine * cosine * static_cast<double>(k - 1) / static_cast<double>(k);
    sum += term;
  }
  const double inside = is_odd ? 2.0 / std::numbers::pi * (angle + sine * sum) : sine * sum;
  return std::clamp(1.0 - inside, 0.0, 1.0);
}

double student_quantile(double p, std::size_t freedom) {
  struct Last {
    double p = 0.0;
    std::size_t freedom = 0;
    double quantile = 0.0;
  };
  static thread_local Last last;  // intervals of one comparison have the same size
  if (last.p == p && last.freedom == freedom) return last.quantile;
  double low = 0.0;
  double high = 1.0;
  while (student_p(high, freedom) > p && std::isfinite(high)) high *= 2.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (student_p(middle, freedom) > p ? low : high) = middle;
  }
  last = {p, freedom, high};
  return high;
}

}  // namespace loopbench::harness
