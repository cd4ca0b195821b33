/// The family hyperbola: y = c0 + c1 / (x + q). Named in the article, never used there.
#pragma once

#include <optional>
#include <span>

#include "methods/smoothers/manifold/families/extent.hpp"
#include "methods/smoothers/manifold/jet.hpp"

namespace loopbench::manifold {

/// Written c0 + c1 scale / (x - pole) so that c0 and c1 are lengths.
struct Hyperbola {
  double pole = 0.0;   ///< -q [m]
  double scale = 1.0;  ///< [m]
  double c0 = 0.0, c1 = 0.0;

  template <class T>
  T operator()(const T& x) const {
    return c0 + (c1 * scale) / (x - pole);
  }
};

/// Least squares in y: a grid of poles on both sides, then Levenberg-Marquardt. Four points or
/// more with distinct x. Nothing when the pole comes nearer to the range of x than half a range.
std::optional<Hyperbola> fit_hyperbola(std::span<const Vector2> points);

}  // namespace loopbench::manifold
