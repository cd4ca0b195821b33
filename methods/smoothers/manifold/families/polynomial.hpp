/// The families line, poly2 and poly3: y = a0 + a1 x + a2 x^2 + a3 x^3.
#pragma once

#include <span>

#include "methods/smoothers/manifold/frame.hpp"

namespace loopbench::manifold {

struct Polynomial {
  double centre = 0.0;                                     ///< of the fitted x [m]
  double scale = 1.0;                                      ///< half their range [m]
  Eigen::Vector4d coefficients = Eigen::Vector4d::Zero();  ///< of powers of u [m]

  template <class T>
  T operator()(const T& x) const {
    const T u = (x - centre) / scale;
    const auto& a = coefficients;
    return a[0] + u * (a[1] + u * (a[2] + u * a[3]));
  }
};

/// Least squares in y by QR, x centred and scaled to [-1, 1]; with degree + 1 points it passes
/// through all of them. The degree (1..3) is lowered to the number of points less one.
/// Needs two points or more with distinct x, twelve at most.
Polynomial fit_polynomial(std::span<const Vector2> points, int degree);

}  // namespace loopbench::manifold
