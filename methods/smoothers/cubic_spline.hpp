/// A natural cubic spline in time through the keyframes: the smooth curve to beat.
#pragma once

#include "methods/method.hpp"

namespace loopbench {

/// Positions: the interpolating cubic B-spline with natural ends (zero acceleration), knots at
/// the keyframes. Attitude: a cumulative cubic B-spline on SO(3) through the keyframes with zero
/// angular acceleration at the ends (spline_controls.hpp), or great arcs. Both are C2 in time.
/// One keyframe gives a constant, two a straight line and a great arc.
/// Complexity O(n) to make; O(1) amortised for sorted times, O(log n) otherwise.
class CubicSpline final : public Smoother {
 public:
  enum class Turn { slerp, spline };
  struct Options {
    Turn rotation = Turn::spline;
  };
  explicit CubicSpline(const Options& options) : options_(options) {}

  std::optional<std::string> declines(const Problem& problem) const override;

  /// Counts: `iterations` of the rotation solve. When it finds no spline through all
  /// keyframes, splines through stretches of them are joined by great arcs: `great_arcs` and a
  /// note.
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

inline auto choices(CubicSpline::Turn) {
  return std::array{std::pair{"slerp", CubicSpline::Turn::slerp},
                    std::pair{"spline", CubicSpline::Turn::spline}};
}

template <class Visit>
void fields(CubicSpline::Options& o, Visit visit) {
  visit("rotation", o.rotation, "slerp: great arcs; spline: smooth as the positions are");
}

}  // namespace loopbench
