#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "harness/profile/profile.hpp"
#include "harness/statistics/ranks.hpp"

namespace loopbench::harness {

std::optional<PowerLaw> power_law(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  const auto above_zero = [](double value) { return value > 0.0; };
  if (n < 3 || !std::ranges::all_of(x, above_zero) || !std::ranges::all_of(y, above_zero)) {
    return std::nullopt;
  }
  const auto [low, high] = std::ranges::minmax(x);
  if (high < 4.0 * low) return std::nullopt;
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    mean_x += std::log(x[i]) / static_cast<double>(n);
    mean_y += std::log(y[i]) / static_cast<double>(n);
  }
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double dx = std::log(x[i]) - mean_x;
    const double dy = std::log(y[i]) - mean_y;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
  }
  PowerLaw out;
  out.exponent = xy / xx;
  const double left = std::max(0.0, yy - out.exponent * xy);  // residual sum of squares
  out.error = std::sqrt(left / static_cast<double>(n - 2) / xx);
  out.r2 = yy > 0.0 ? 1.0 - left / yy : 1.0;
  return out;
}

std::vector<bool> pareto_front(const std::vector<double>& a, const std::vector<double>& b) {
  const auto less = [](double x, double y) { return x < y && !tied(x, y, kRelevant); };
  const auto beats = [&](std::size_t i, std::size_t j) {
    const bool is_worse = less(a[j], a[i]) || less(b[j], b[i]);
    return !is_worse && (less(a[i], a[j]) || less(b[i], b[j]));
  };
  std::vector<bool> out(a.size(), true);
  for (std::size_t j = 0; j < a.size(); ++j) {
    for (std::size_t i = 0; i < a.size() && out[j]; ++i) out[j] = !beats(i, j);
  }
  return out;
}

}  // namespace loopbench::harness
