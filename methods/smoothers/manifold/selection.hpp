/// Step 9: selection of a window's family, based on its keyframes and never on the reference.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace loopbench::methods::manifold {

/// fixed: the first family of the list that can be fitted. aicc: lowest corrected Akaike
/// information criterion. loocv: lowest squared error in leave-one-out cross-validation over the
/// nodes.
enum class Selection { fixed, aicc, loocv };
inline auto choices(Selection) {
  return std::array{std::pair{"fixed", Selection::fixed},
                    std::pair{"aicc", Selection::aicc},
                    std::pair{"loocv", Selection::loocv}};
}

/// Returns n ln(RSS / n) + 2 k + 2 k (k + 1) / (n - k - 1), where k is the number of parameters + 1
/// for the variance. Infinite for n <= k + 1: five nodes admit only a line, six also a parabola.
/// The mean squared residual is bounded below by (1 um)^2. Source: Hurvich and Tsai, Biometrika
/// 76(2) 1989.
inline double aicc(double residual_squares, std::size_t nodes, std::size_t parameters) {
  const double n = static_cast<double>(nodes);
  const double k = static_cast<double>(parameters) + 1.0;
  if (n <= k + 1.0) return std::numeric_limits<double>::infinity();
  constexpr double floor = 1e-12;  // [m^2]
  return n * std::log(std::max(residual_squares / n, floor)) + 2.0 * k +
         2.0 * k * (k + 1.0) / (n - k - 1.0);
}

}  // namespace loopbench::methods::manifold
