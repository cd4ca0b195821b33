/// The family quadric: z = q(x, y) with the article's seven monomials x^2, y^2, z, xy, y, x, 1.
#pragma once

#include <optional>
#include <span>

#include "methods/smoothers/manifold/frame.hpp"
#include "methods/smoothers/manifold/jet.hpp"

namespace loopbench::methods::manifold {

constexpr double kQuadricCut = 1e-3;  ///< relative to the largest singular value

struct Quadric {
  using Coefficients = Eigen::Matrix<double, 6, 1>;

  Vector2 centre = Vector2::Zero();                  ///< middle of the fitted points [m]
  double scale = 1.0;                                ///< half their larger range [m]
  double level = 0.0;                                ///< their mean z [m]
  Coefficients coefficients = Coefficients::Zero();  ///< of x^2, y^2, xy, x, y, 1 [m]
  int rank = 0;  ///< number of directions kept; below 6 the points lie on or near a conic

  double operator()(const Vector2& point) const {
    return level + monomials((point - centre) / scale).dot(coefficients);
  }
  Jet<double> operator()(const Jet<double>& x, const Jet<double>& y) const {
    const Jet<double> u = (x - centre.x()) / scale;
    const Jet<double> v = (y - centre.y()) / scale;
    const Coefficients& c = coefficients;
    return level + c[5] + u * (c[0] * u + c[2] * v + c[3]) + v * (c[1] * v + c[4]);
  }
  static Coefficients monomials(const Vector2& u);
};

/// Least-squares fit in z by truncated SVD. Six nodes of a short path lie near a conic, where the
/// full solution amplifies noise; directions with a singular value below `cut` relative to the
/// largest are dropped. Interpolates six points if none is dropped. x and y have a common scale,
/// because separate scales would amplify the noise across a straight path to its length. Returns
/// nullopt for points without extent or fewer than six points; at most twelve are allowed.
std::optional<Quadric> fit_quadric(std::span<const Vector2> points,
                                   std::span<const double> z,
                                   double cut = kQuadricCut);

}  // namespace loopbench::methods::manifold
