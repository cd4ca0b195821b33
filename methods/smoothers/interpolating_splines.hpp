/// Splines in time through the keyframes: natural cubic and B-spline of order k. Joined by chords
/// where no spline is possible.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "datasets/core/curve.hpp"
#include "methods/method.hpp"
#include "methods/report.hpp"
#include "methods/smoothers/runs/pose_runs.hpp"
#include "methods/smoothers/spline/interpolate.hpp"

namespace loopbench::methods {

struct SplineControls {
  SplineBasis basis;
  std::vector<Vector3> points;
  std::optional<RotationControls> rotations;  ///< none: no such spline was found
};

/// Returns the curve whose controls `solve` computes from two or more poses, with the count
/// `iterations` of the rotation solve. If no rotation spline through all keyframes exists, splines
/// through parts of them are joined by great arcs, with the count `great_arcs` and a note. Short
/// intervals (pose_runs.hpp) are bridged by chords, with a note.
std::unique_ptr<const Curve> spline_through(
    const Trajectory& keyframes,
    Report& report,
    const std::function<SplineControls(const Trajectory&)>& solve);

/// Positions: the interpolating cubic B-spline with natural ends (zero acceleration) and knots at
/// the keyframes. Rotation: a cumulative cubic B-spline on SO(3) through the keyframes with zero
/// angular acceleration at the ends (spline/interpolate.hpp), or great arcs (spline_through()).
/// Both splines are C2 in time. One keyframe gives a constant, two a straight line and a great arc.
/// O(n) to construct; O(1) amortised per query for sorted times, O(log n) otherwise.
class CubicSpline final : public Smoother {
 public:
  using Options = NoOptions;
  explicit CubicSpline(const Options&) {}

  /// Counts and notes: see spline_through().
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override {
    return spline_through(problem.keyframes, report, [](const Trajectory& keyframes) {
      constexpr std::size_t kOrder = 4;
      const SplineBasis basis(kOrder, stamps(keyframes));
      return SplineControls{basis,
                            natural_controls(basis, positions_of(keyframes)),
                            natural_rotation_controls(basis, rotations_of(keyframes))};
    });
  }
};

/// Positions: sum of N_j(t) c_j through every keyframe. Inner knots are means of k - 1 stamps, so
/// no end condition is needed and polynomials of degree k - 1 are reproduced. Rotation: the
/// cumulative spline on SO(3) through the keyframes, on the same knots; if it does not exist,
/// splines through parts of the trajectory, joined by great arcs (spline_through()). C^{k-2} in
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
                            interpolating_rotation_controls(basis, sites, rotations_of(keyframes))};
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
