#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "harness/profile/profile.hpp"

namespace loopbench {

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
  const double left = std::max(0.0, yy - out.exponent * xy);  // squares the line does not explain
  out.error = std::sqrt(left / static_cast<double>(n - 2) / xx);
  out.r2 = yy > 0.0 ? 1.0 - left / yy : 1.0;
  return out;
}

std::vector<bool> pareto_front(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<std::size_t> order(a.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t i, std::size_t j) {
    return a[i] != a[j] ? a[i] < a[j] : b[i] < b[j];
  });
  std::vector<bool> out(a.size(), false);
  double best = std::numeric_limits<double>::infinity();  // b of those with a smaller a
  double here = best;                                     // b of the best with the same a
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t i = order[k];
    if (k > 0 && a[i] != a[order[k - 1]]) {
      best = std::min(best, here);
      here = std::numeric_limits<double>::infinity();
    }
    here = std::min(here, b[i]);
    out[i] = b[i] < best && b[i] <= here;
  }
  return out;
}

}  // namespace loopbench
