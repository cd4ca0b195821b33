#include "methods/smoothers/manifold/families/polynomial.hpp"

#include <Eigen/QR>
#include <algorithm>

#include "methods/smoothers/manifold/families/levenberg_marquardt.hpp"

namespace loopbench::methods::manifold {

Polynomial fit_polynomial(std::span<const Vector2> points, int degree) {
  const auto count = static_cast<Eigen::Index>(points.size());
  const auto [left, right] = std::minmax_element(
      points.begin(), points.end(), [](const auto& a, const auto& b) { return a.x() < b.x(); });
  Polynomial out;
  out.centre = 0.5 * (left->x() + right->x());
  out.scale = 0.5 * (right->x() - left->x());

  const Eigen::Index terms = std::min<Eigen::Index>(degree + 1, count);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxNodes, 4> powers(count, terms);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxNodes, 1> y(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vector2& point = points[static_cast<std::size_t>(i)];
    y[i] = point.y();
    powers(i, 0) = 1.0;
    for (Eigen::Index k = 1; k < terms; ++k) {
      powers(i, k) = powers(i, k - 1) * (point.x() - out.centre) / out.scale;
    }
  }
  out.coefficients.head(terms) = powers.householderQr().solve(y);
  return out;
}

}  // namespace loopbench::methods::manifold
