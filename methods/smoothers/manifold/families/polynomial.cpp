#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>

#include "methods/smoothers/manifold/families/fitting.hpp"
#include "methods/smoothers/manifold/families/graph.hpp"

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

std::string coefficient_text(const Polynomial& curve, int degree) {
  // Expands Horner's scheme in u = (x - m) / s into powers of x, from the inside.
  const double slope = 1.0 / curve.scale;
  const double offset = -curve.centre / curve.scale;
  Eigen::Vector4d powers = Eigen::Vector4d::Zero();
  for (int k = degree; k >= 0; --k) {
    Eigen::Vector4d next = offset * powers;
    next.tail<3>() += slope * powers.head<3>();
    next[0] += curve.coefficients[k];
    powers = next;
  }
  std::string out;
  for (int k = degree; k > 0; --k) out += fmt::format("alpha({},0) = {:.6g}, ", k, powers[k]);
  return out + fmt::format("alpha(0,1) = 1, alpha(0,0) = {:.6g}", powers[0]);
}

}  // namespace loopbench::methods::manifold
