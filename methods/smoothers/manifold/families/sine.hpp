/// The family sin1: y = a sin(b x + c) [+ d].
#pragma once

#include <optional>
#include <span>

#include "methods/smoothers/manifold/families/extent.hpp"
#include "methods/smoothers/manifold/jet.hpp"

namespace loopbench::manifold {

struct Sine {
  double amplitude = 0.0;  ///< a [m], >= 0
  double rate = 1.0;       ///< b [rad/m], > 0
  double phase = 0.0;      ///< c [rad]
  double level = 0.0;      ///< d [m]; 0 in the article

  template <class T>
  T operator()(const T& x) const {
    using std::sin;
    return level + amplitude * sin(rate * x + phase);
  }
};

/// Least squares in y from twelve starts of the rate. Four points or more with distinct x, one
/// more `with_level`. Nothing when the best curve is an alias: wavelength below 4 mean spacings of
/// the points, or amplitude above twice their range of y.
std::optional<Sine> fit_sine(std::span<const Vector2> points, bool with_level);

}  // namespace loopbench::manifold
