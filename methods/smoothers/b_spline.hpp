/// Interpolating B-spline of order k in time through the keyframes.
#pragma once

#include "methods/method.hpp"
#include "methods/smoothers/parts.hpp"
#include "methods/smoothers/spline/through.hpp"

namespace loopbench::methods {

/// Positions: sum of N_j(t) c_j through every keyframe. Inner knots are means of k - 1 stamps, so
/// no end condition is needed and polynomials of degree k - 1 are reproduced. Rotation: the
/// cumulative spline on SO(3) through the keyframes, on the same knots; if it does not exist,
/// splines through parts of the trajectory, joined by great arcs (spline/through.hpp). C^{k-2} in
/// time; order 2 is the polyline. With fewer than k keyframes the order is their number. Solves a
/// banded system with k - 1 diagonals on each side: O(n k^2) to construct, O(k^2) amortised per
/// query. Sources: de Boor, A Practical Guide to Splines, ch. XIII; Kim, Kim & Shin 1995.
class BSplineThrough final : public Smoother {
 public:
  struct Options {
    int order = 4;
  };
  explicit BSplineThrough(const Options& options) : options_(options) {}

  /// Counts and notes: see spline_through().
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override {
    return spline_through(problem.keyframes, report, [&](const Trajectory& keyframes) {
      const std::vector<double> sites = stamps(keyframes);
      const auto basis = SplineBasis::for_sites(static_cast<std::size_t>(options_.order), sites);
      return SplineControls{basis,
                            interpolating_controls(basis, sites, positions_of(keyframes)),
                            interpolating_rotation_controls(basis, sites, attitudes(keyframes))};
    });
  }

 private:
  Options options_;
};

template <class Visit>
void fields(BSplineThrough::Options& o, Visit visit) {
  visit("order", o.order, "order of the spline (degree plus one)", Between{2, 6});
}

}  // namespace loopbench::methods
