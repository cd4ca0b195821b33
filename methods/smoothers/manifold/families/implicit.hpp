/// The family F(x, y) = sum over i + j <= n of alpha(i,j) x^i y^j = 0, equation (9).
#pragma once

#include <array>
#include <optional>
#include <span>
#include <utility>

#include "methods/smoothers/manifold/families/extent.hpp"
#include "methods/smoothers/manifold/families/levenberg_marquardt.hpp"
#include "methods/smoothers/manifold/jet.hpp"

namespace loopbench::methods::manifold {

/// Returns the number of (i, j) with i + j <= n.
inline Eigen::Index implicit_terms(int order) { return (order + 1) * (order + 2) / 2; }

/// Returns the powers (i, j) of monomial k in the article's order: falling total degree, then
/// falling power of x; x^2, xy, y^2, x, y, 1 for n = 2.
std::pair<int, int> implicit_powers(int order, Eigen::Index k);

struct Implicit {
  int order = 1;                     ///< n, 1..3
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
    const std::array<T, 4> x{zero + 1.0, u, u * u, u * u * u};
    const std::array<T, 4> y{zero + 1.0, v, v * v, v * v * v};
    Evaluation<T> out{zero, zero, zero};
    for (Eigen::Index k = 0; k < alpha.size(); ++k) {
      const auto [i, j] = implicit_powers(order, k);
      const auto a = static_cast<std::size_t>(i);
      const auto b = static_cast<std::size_t>(j);
      out.f = out.f + alpha[k] * (x[a] * y[b]);
      if (i > 0) out.by_u = out.by_u + (i * alpha[k]) * (x[a - 1] * y[b]);
      if (j > 0) out.by_v = out.by_v + (j * alpha[k]) * (x[a] * y[b - 1]);
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
/// distance to the curve. Requires at least as many points as unknowns - 1 (2, 5, 9 for n = 1, 2,
/// 3) and at most twelve. Returns nullopt for fewer points or points without extent. Source:
/// Taubin, PAMI 13(11) 1991; Sampson, CGIP 18 1982.
std::optional<Implicit> fit_implicit(std::span<const Vector2> points, int order);

}  // namespace loopbench::methods::manifold
