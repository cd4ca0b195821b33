/// B-splines of order k: the article's equations (11) and (12). A cubic has k = 4.
#pragma once

#include "methods/smoothers/manifold/jet.hpp"
#include "methods/smoothers/spline/basis.hpp"

namespace loopbench::methods::manifold {

/// C(u) = sum of P_t N_{t,k}(u).
struct BSpline {
  using Value = Eigen::Vector4d;

  SplineBasis basis;
  std::vector<Value> controls;

  /// Interpolates values[i] at sites[i] (at least two, strictly increasing); the first value must
  /// be zero for full precision. Order 2..6, reduced to the number of sites. O(n k^2).
  static BSpline through(const std::vector<double>& sites,
                         const std::vector<Value>& values,
                         std::size_t order);

  /// Least-squares fit of order 4, the C2 piecewise cubic, with the given inner knots (increasing,
  /// strictly inside). A penalty of 1e-9 on the second differences of the control polygon makes
  /// controls without data unique. Sites must be non-decreasing, the first below the last. O(n).
  static BSpline near(const std::vector<double>& sites,
                      const std::vector<Value>& values,
                      const std::vector<double>& inner_knots);

  Value at(double u) const;
  Jet<Value> at(const Jet<double>& u) const;
};

}  // namespace loopbench::methods::manifold
