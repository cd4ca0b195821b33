/// The interpolating B-spline of order k in time through the keyframes.
#pragma once

#include "methods/method.hpp"

namespace loopbench {

/// Positions: sum of N_j(t) c_j through every keyframe, inner knots in the mean of k - 1 stamps
/// (no end condition: polynomials of degree k - 1 are reproduced). Attitude: the cumulative spline
/// on SO(3) through the keyframes, on the same knots; where none is found, on stretches joined by
/// great arcs (stretches.hpp). C^{k-2} in time; order 2 is the polyline. With fewer than k
/// keyframes the order is their number. A system of k - 1 diagonals on either side: O(n k^2) to
/// make, O(k^2) amortised to ask. Source: de Boor, A Practical Guide to Splines, ch. XIII; Kim, Kim
/// & Shin 1995.
class BSplineThrough final : public Smoother {
 public:
  struct Options {
    int order = 4;
  };
  explicit BSplineThrough(const Options& options) : options_(options) {}

  std::optional<std::string> declines(const Problem& problem) const override;

  /// Counts: `iterations` of the rotation solve. Great arcs are counted and noted.
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

template <class Visit>
void fields(BSplineThrough::Options& o, Visit visit) {
  visit("order", o.order, "of the spline, its degree plus one", Between{2, 6});
}

}  // namespace loopbench
