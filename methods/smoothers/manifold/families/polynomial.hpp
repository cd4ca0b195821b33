/// The families line, poly2 and poly3: y = a0 + a1 x + a2 x^2 + a3 x^3.
#pragma once

#include <span>
#include <string>

#include "methods/smoothers/manifold/frame.hpp"

namespace loopbench::methods::manifold {

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

/// Coefficients of y = +f(x) in metres of the window's frame, in the article's notation and order:
/// "alpha(2,0) = 1.238, ..., alpha(0,1) = 1, alpha(0,0) = -0.5163". The article's F = ... + y = 0
/// would mean y = -f(x), but its printed numbers fit the ground truth with the other sign (design
/// section 3), which is used here.
std::string coefficient_text(const Polynomial& curve, int degree);

}  // namespace loopbench::methods::manifold
