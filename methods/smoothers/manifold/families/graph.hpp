/// The families of curves y = f(x).
#pragma once

#include <optional>
#include <span>

#include "methods/smoothers/manifold/families/frame.hpp"
#include "methods/smoothers/manifold/families/jet.hpp"

namespace loopbench::methods::manifold {

/// line, poly2 and poly3: y = a0 + a1 x + a2 x^2 + a3 x^3.
struct Polynomial {
  double centre = 0.0;  ///< middle of the fitted x [m]
  double scale = 1.0;   ///< half the range of x [m]; u = (x - centre) / scale
  Eigen::Vector4d coefficients = Eigen::Vector4d::Zero();  ///< of powers of u [m]

  template <class T>
  T operator()(const T& x) const {
    const T u = (x - centre) / scale;
    const auto& a = coefficients;
    return a[0] + u * (a[1] + u * (a[2] + u * a[3]));
  }
};

/// Least-squares fit in y by QR, with x centred and scaled to [-1, 1]; degree + 1 points are
/// interpolated. The degree (1..3) is reduced to the number of points - 1. Requires two to twelve
/// points with distinct x.
Polynomial fit_polynomial(std::span<const Vector2> points, int degree);

/// sin1: y = a sin(b x + c).
struct Sine {
  double amplitude = 0.0;  ///< a [m], >= 0
  double rate = 1.0;       ///< b [rad/m], > 0
  double phase = 0.0;      ///< c [rad]

  template <class T>
  T operator()(const T& x) const {
    using std::sin;
    return amplitude * sin(rate * x + phase);
  }
};

/// Least-squares fit in y from twelve initial rates. Requires at least four points with distinct x.
/// Returns nullopt when the best curve is an alias: wavelength below 4 mean point spacings, or
/// amplitude above twice the range of y.
std::optional<Sine> fit_sine(std::span<const Vector2> points);

/// rat02: y = p / (x^2 + q1 x + q2), stored relative to the middle of the window.
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

/// hyperbola: y = c0 + c1 / (x + q), stored as c0 + c1 scale / (x - pole), so that c0 and c1 are
/// lengths.
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
