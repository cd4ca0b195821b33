/// The family sin1: y = a sin(b x + c).
#pragma once

#include <optional>
#include <span>

#include "methods/smoothers/manifold/families/extent.hpp"
#include "methods/smoothers/manifold/jet.hpp"

namespace loopbench::methods::manifold {

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

}  // namespace loopbench::methods::manifold
