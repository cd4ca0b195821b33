/// B-splines of order k: the article's equations (11) and (12), the latter repaired.
///
/// Printed, the second numerator of (12) is m_{t+k}; it must be m_{t+k} - u, else the basis is no
/// partition of unity. Order k is degree k - 1: a cubic has k = 4.
#pragma once

#include <span>

#include "methods/smoothers/manifold/jet.hpp"

namespace loopbench::manifold {

constexpr std::size_t kMostOrder = 6;

/// N_{t,k}(u) for the k basis functions t = span - k + 1 .. span that are not zero between
/// knots[span] and knots[span + 1]: the recursion (12) from order 1 up. O(k^2).
template <class T>
std::array<T, kMostOrder> basis(std::span<const double> knots,
                                std::size_t k,
                                std::size_t span,
                                const T& u) {
  std::array<T, kMostOrder> out{};
  out[0] = 0.0 * u + 1.0;
  for (std::size_t order = 2; order <= k; ++order) {
    T carried = 0.0 * u;
    for (std::size_t r = 0; r + 1 < order; ++r) {
      const double right = knots[span + 1 + r];
      const double left = knots[span + 2 + r - order];
      const T part = (1.0 / (right - left)) * out[r];
      out[r] = carried + (right - u) * part;
      carried = (u - left) * part;
    }
    out[order - 1] = carried;
  }
  return out;
}

/// C(u) = sum of P_t N_{t,k}(u).
class BSpline {
 public:
  using Value = Eigen::Vector4d;

  /// Through values[i] at sites[i] (strictly increasing, two or more). Knots k-fold at both ends,
  /// inside the mean of k - 1 sites, which puts a site under every basis function (Schoenberg and
  /// Whitney; de Boor ch. XIII). Order 2..6, lowered to the number of sites. O(n k^2).
  static BSpline through(std::span<const double> sites,
                         std::span<const Value> values,
                         std::size_t order);

  /// Least squares with the given inner knots (strictly inside, increasing): the C2 piecewise
  /// cubic for order 4. A penalty of 1e-9 on the bending of the control polygon decides what no
  /// site does. Sites non-decreasing, first below last. O(n k^2).
  static BSpline near(std::span<const double> sites,
                      std::span<const Value> values,
                      std::span<const double> inner_knots,
                      std::size_t order);

  std::size_t order() const { return order_; }
  const std::vector<double>& knots() const { return knots_; }
  const std::vector<Value>& controls() const { return controls_; }

  /// The span u lies in; the last one is closed on the right. O(log n).
  std::size_t span(double u) const;

  Value at(double u) const;
  Jet<Value> at(const Jet<double>& u) const;

 private:
  std::size_t order_ = 4;
  std::vector<double> knots_;
  std::vector<Value> controls_;
};

}  // namespace loopbench::manifold
