/// The family F(x, y) = sum over i + j <= 2 of alpha(i,j) x^i y^j = 0, equation (9).
#pragma once

#include <array>
#include <optional>
#include <span>
#include <utility>

#include "methods/smoothers/manifold/families/fitting.hpp"
#include "methods/smoothers/manifold/families/jet.hpp"

namespace loopbench::methods::manifold {

/// Powers (i, j) of the monomials in the article's order: x^2, xy, y^2, x, y, 1.
inline constexpr std::array<std::pair<std::size_t, std::size_t>, 6> kImplicitPowers{
    {{2, 0}, {1, 1}, {0, 2}, {1, 0}, {0, 1}, {0, 0}}};

struct Implicit {
  Vector2 centre = Vector2::Zero();  ///< origin of the scaled coordinates [m]
  double scale = 1.0;                ///< common scale of both coordinates [m]
  Parameters alpha;                  ///< |alpha| = 1

  /// F and its gradient with respect to scaled coordinates.
  template <class T>
  struct Evaluation {
    T f, by_u, by_v;
  };
  template <class T>
  Evaluation<T> evaluate(const T& u, const T& v) const {
    const T zero = 0.0 * u;
    const std::array<T, 3> x{zero + 1.0, u, u * u};
    const std::array<T, 3> y{zero + 1.0, v, v * v};
    Evaluation<T> out{zero, zero, zero};
    for (Eigen::Index k = 0; k < alpha.size(); ++k) {
      const auto [i, j] = kImplicitPowers[static_cast<std::size_t>(k)];
      out.f = out.f + alpha[k] * (x[i] * y[j]);
      if (i > 0) out.by_u = out.by_u + (static_cast<double>(i) * alpha[k]) * (x[i - 1] * y[j]);
      if (j > 0) out.by_v = out.by_v + (static_cast<double>(j) * alpha[k]) * (x[i] * y[j - 1]);
    }
    return out;
  }

  /// Returns the point of the curve near (x, y), by steps along the gradient until F is zero to
  /// rounding. For jets the derivatives converge one step later. Returns nullopt when the steps do
  /// not converge, for example near a singular point of the curve.
  template <class T>
  std::optional<std::pair<T, T>> nearest(const T& x, const T& y) const {
    constexpr int steps = 30;
    constexpr double close = 1e-12;  // [of the scale]
    T u = (x - centre.x()) / scale;
    T v = (y - centre.y()) / scale;
    int converged_steps = 0;
    for (int i = 0; i < steps; ++i) {
      const Evaluation<T> at = evaluate(u, v);
      const T step_factor = at.f * (1.0 / (at.by_u * at.by_u + at.by_v * at.by_v));
      const T du = step_factor * at.by_u;
      const T dv = step_factor * at.by_v;
      const double step = std::hypot(value_of(du), value_of(dv));
      if (!(step < 1.0)) return std::nullopt;
      u = u - du;
      v = v - dv;
      if (step < close) ++converged_steps;
      if (converged_steps == 3) return std::pair{scale * u + centre.x(), scale * v + centre.y()};
    }
    return std::nullopt;
  }
};

/// Taubin's fit (the eigenvector that minimises F^2 over the squared gradient), followed by
/// Levenberg-Marquardt on the Sampson distance F / |grad F|, the first-order approximation of the
/// distance to the curve. Requires five to twelve points. Returns nullopt for fewer points or
/// points without extent. Source: Taubin, PAMI 13(11) 1991; Sampson, CGIP 18 1982.
std::optional<Implicit> fit_implicit(std::span<const Vector2> points);

}  // namespace loopbench::methods::manifold
