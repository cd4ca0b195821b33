/// The families rat02, y = p / (x^2 + q1 x + q2), and hyperbola, y = c0 + c1 / (x + q).
#pragma once

#include <optional>
#include <span>

#include "methods/smoothers/manifold/families/extent.hpp"
#include "methods/smoothers/manifold/jet.hpp"

namespace loopbench::methods::manifold {

/// Stored relative to the middle of the window.
struct Rational {
  double centre = 0.0;  ///< [m]
  double scale = 1.0;   ///< [m]; u = (x - centre) / scale
  double p = 0.0;       ///< [m]
  double q1 = 0.0, q2 = 1.0;

  template <class T>
  T operator()(const T& x) const {
    const T u = (x - centre) / scale;
    return p / (u * (u + q1) + q2);
  }
};

/// Least-squares fit in y by Levenberg-Marquardt from the linearised solution. Requires at least
/// four points with distinct x. Returns nullopt when the denominator has a real root within the
/// range of x or half that range on either side of it.
std::optional<Rational> fit_rational(std::span<const Vector2> points);

/// Stored as c0 + c1 scale / (x - pole), so that c0 and c1 are lengths.
struct Hyperbola {
  double pole = 0.0;   ///< -q [m]
  double scale = 1.0;  ///< [m]
  double c0 = 0.0, c1 = 0.0;

  template <class T>
  T operator()(const T& x) const {
    return c0 + (c1 * scale) / (x - pole);
  }
};

/// Least-squares fit in y: a grid of poles on both sides, then Levenberg-Marquardt. Requires at
/// least four points with distinct x. Returns nullopt when the pole is closer to the range of x
/// than half that range.
std::optional<Hyperbola> fit_hyperbola(std::span<const Vector2> points);

}  // namespace loopbench::methods::manifold
