/// Step 9: which family a window takes, judged on its keyframes and never on the reference.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace loopbench::manifold {

/// fixed: the first of the list that can be fitted. aicc: least corrected Akaike criterion.
/// loocv: least squared error at nodes left out of the fit, one at a time.
enum class Selection { fixed, aicc, loocv };
inline auto choices(Selection) {
  return std::array{std::pair{"fixed", Selection::fixed},
                    std::pair{"aicc", Selection::aicc},
                    std::pair{"loocv", Selection::loocv}};
}

/// n ln(RSS / n) + 2 k + 2 k (k + 1) / (n - k - 1), k = parameters and the variance. Infinite where
/// n <= k + 1: five nodes let a line compete and nothing else, six a parabola as well. Residuals
/// below a micrometre count as that. Source: Hurvich and Tsai, Biometrika 76(2) 1989.
inline double aicc(double residual_squares, std::size_t nodes, std::size_t parameters) {
  const double n = static_cast<double>(nodes);
  const double k = static_cast<double>(parameters) + 1.0;
  if (n <= k + 1.0) return std::numeric_limits<double>::infinity();
  constexpr double floor = 1e-12;  // [m^2]
  return n * std::log(std::max(residual_squares / n, floor)) + 2.0 * k +
         2.0 * k * (k + 1.0) / (n - k - 1.0);
}

}  // namespace loopbench::manifold
