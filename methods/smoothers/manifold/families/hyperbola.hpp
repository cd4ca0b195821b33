/// The family hyperbola: y = c0 + c1 / (x + q). The article names it but does not use it.
#pragma once

#include <optional>
#include <span>

#include "methods/smoothers/manifold/families/extent.hpp"
#include "methods/smoothers/manifold/jet.hpp"

namespace loopbench::methods::manifold {

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
