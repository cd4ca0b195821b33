/// The family quadric: z = q(x, y) of the paper's seven monomials x^2, y^2, z, xy, y, x, 1.
#pragma once

#include <optional>
#include <span>

#include "methods/smoothers/manifold/frame.hpp"
#include "methods/smoothers/manifold/jet.hpp"

namespace loopbench::manifold {

constexpr double kQuadricCut = 1e-3;  ///< [of the largest singular value]

struct Quadric {
  using Coefficients = Eigen::Matrix<double, 6, 1>;

  Vector2 centre = Vector2::Zero();                  ///< of the fitted points [m]
  double scale = 1.0;                                ///< half their larger range [m]
  double level = 0.0;                                ///< their mean z [m]
  Coefficients coefficients = Coefficients::Zero();  ///< of x^2, y^2, xy, x, y, 1 [m]
  int rank = 0;  ///< directions kept; below 6 the points lie on or near a conic

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

/// Least squares in z by truncated SVD: along a short path six nodes lie near a conic, where the
/// full solution is noise blown up, so directions below `cut` of the strongest are dropped.
/// Passes through six points when none is dropped. x and y share one scale: scaling each by
/// itself would blow the noise across a straight path up to its length.
/// Nothing when the points have no extent or are fewer than six; twelve at most.
std::optional<Quadric> fit_quadric(std::span<const Vector2> points,
                                   std::span<const double> z,
                                   double cut = kQuadricCut);

}  // namespace loopbench::manifold
