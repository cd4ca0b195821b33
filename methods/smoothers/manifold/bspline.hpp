/// B-splines of order k: the article's equations (11) and (12), with (12) corrected.
///
/// The second numerator of (12) is printed as m_{t+k}; it must be m_{t+k} - u, otherwise the basis
/// is no partition of unity. Order k is degree k - 1: a cubic has k = 4.
#pragma once

#include <span>

#include "methods/smoothers/manifold/jet.hpp"

namespace loopbench::methods::manifold {

constexpr std::size_t kMaxOrder = 6;

/// Returns N_{t,k}(u) for the k basis functions t = span - k + 1 .. span that are nonzero between
/// knots[span] and knots[span + 1], by the recursion (12) from order 1. O(k^2).
template <class T>
std::array<T, kMaxOrder> basis(std::span<const double> knots,
                               std::size_t k,
                               std::size_t span,
                               const T& u) {
  std::array<T, kMaxOrder> out{};
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

  /// Interpolates values[i] at sites[i] (at least two, strictly increasing). End knots are repeated
  /// k times; inner knots are means of k - 1 sites, so the Schoenberg-Whitney conditions hold (de
  /// Boor ch. XIII). Order 2..6, reduced to the number of sites. O(n k^2).
  static BSpline through(std::span<const double> sites,
                         std::span<const Value> values,
                         std::size_t order);

  /// Least-squares fit with the given inner knots (increasing, strictly inside); for order 4 the C2
  /// piecewise cubic. A penalty of 1e-9 on the second differences of the control polygon makes
  /// controls without data unique. Sites must be non-decreasing, the first below the last. O(n
  /// k^2).
  static BSpline near(std::span<const double> sites,
                      std::span<const Value> values,
                      std::span<const double> inner_knots,
                      std::size_t order);

  std::size_t order() const { return order_; }
  const std::vector<double>& knots() const { return knots_; }
  const std::vector<Value>& controls() const { return controls_; }

  /// Returns the index of the span that contains u; the last span is closed on the right. O(log n).
  std::size_t span(double u) const;

  Value at(double u) const;
  Jet<Value> at(const Jet<double>& u) const;

 private:
  std::size_t order_ = 4;
  std::vector<double> knots_;
  std::vector<Value> controls_;
};

}  // namespace loopbench::methods::manifold
