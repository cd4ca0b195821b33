/// Cubic B-spline basis on uneven knots: one knot at every stamp, the end knots repeated four
/// times.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace loopbench::methods {

/// n >= 2 stamps have n + 2 basis functions N_0..N_{n+1}. Between stamps[i] and stamps[i+1] only
/// N_i..N_{i+3} are nonzero. Source: de Boor, A Practical Guide to Splines, ch. IX-X.
class CubicBasis {
 public:
  /// `stamps` must be strictly increasing and have at least two entries.
  explicit CubicBasis(std::vector<double> stamps) : stamps_(std::move(stamps)) {}

  const std::vector<double>& stamps() const { return stamps_; }
  std::size_t size() const { return stamps_.size() + 2; }

  /// Values of N_i..N_{i+3} at a time in stamps[i]..stamps[i+1]; all >= 0, sum 1. O(1).
  std::array<double, 4> values(std::size_t i, double time) const {
    // Cox-de Boor recursion from degree 0 to 3 over the knots around the interval.
    std::array<double, 4> out{1.0, 0.0, 0.0, 0.0};
    for (std::size_t degree = 1; degree <= 3; ++degree) {
      double carried = 0.0;
      for (std::size_t r = 0; r < degree; ++r) {
        const double right = knot(i + 4 + r);
        const double left = knot(i + 4 + r - degree);
        const double part = out[r] / (right - left);
        out[r] = carried + (right - time) * part;
        carried = (time - left) * part;
      }
      out[degree] = carried;
    }
    return out;
  }

  /// Greville abscissa of N_j: the time of its coefficient when the curve is a straight line [s].
  double greville(std::size_t j) const { return (knot(j + 1) + knot(j + 2) + knot(j + 3)) / 3.0; }

  /// Natural ends: the second coefficient lies on the line between its neighbours, at this fraction
  /// from the outer coefficient (0 or size - 1) to the inner one (2 or size - 3).
  double natural_fraction_at_start() const {
    return (greville(1) - greville(0)) / (greville(2) - greville(0));
  }
  double natural_fraction_at_end() const {
    const std::size_t last = size() - 1;
    return (greville(last) - greville(last - 1)) / (greville(last) - greville(last - 2));
  }

 private:
  /// Knot k of the sequence stamps[0] x 4, stamps[1], ..., stamps[n-1] x 4.
  double knot(std::size_t k) const {
    return stamps_[std::min(std::max<std::size_t>(k, 3) - 3, stamps_.size() - 1)];
  }

  std::vector<double> stamps_;
};

}  // namespace loopbench::methods
