#include "methods/smoothers/manifold/families/quadric.hpp"

#include <Eigen/SVD>
#include <numeric>

#include "methods/smoothers/manifold/families/extent.hpp"
#include "methods/smoothers/manifold/families/levenberg_marquardt.hpp"

namespace loopbench::methods::manifold {

Quadric::Coefficients Quadric::monomials(const Vector2& u) {
  Coefficients out;
  out << u.x() * u.x(), u.y() * u.y(), u.x() * u.y(), u.x(), u.y(), 1.0;
  return out;
}

std::optional<Quadric> fit_quadric(std::span<const Vector2> points,
                                   std::span<const double> z,
                                   double cut) {
  const auto count = static_cast<Eigen::Index>(points.size());
  if (count < 6) return std::nullopt;
  const Extent extent(points);
  Quadric out;
  out.centre = extent.centre();
  out.scale = 0.5 * extent.size().maxCoeff();
  out.level = std::accumulate(z.begin(), z.end(), 0.0) / static_cast<double>(count);
  if (!(out.scale > 0.0)) return std::nullopt;

  Eigen::Matrix<double, Eigen::Dynamic, 6, 0, kMaxNodes, 6> design(count, 6);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxNodes, 1> height(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    design.row(i) = Quadric::monomials((points[k] - out.centre) / out.scale).transpose();
    height[i] = z[k] - out.level;
  }
  Eigen::JacobiSVD<decltype(design)> svd(design, Eigen::ComputeFullU | Eigen::ComputeFullV);
  svd.setThreshold(cut);
  out.coefficients = svd.solve(height);
  out.rank = static_cast<int>(svd.rank());
  return out;
}

}  // namespace loopbench::methods::manifold
