/// Natural cubic spline in time through the keyframes.
#pragma once

#include "methods/method.hpp"

namespace loopbench::methods {

/// Positions: the interpolating cubic B-spline with natural ends (zero acceleration) and knots at
/// the keyframes. Rotation: a cumulative cubic B-spline on SO(3) through the keyframes with zero
/// angular acceleration at the ends (spline/interpolate.hpp), or great arcs. Both splines are C2 in
/// time. One keyframe gives a constant, two a straight line and a great arc. O(n) to construct;
/// O(1) amortised per query for sorted times, O(log n) otherwise.
class CubicSpline final : public Smoother {
 public:
  enum class RotationMode { slerp, spline };
  struct Options {
    RotationMode rotation = RotationMode::spline;
  };
  explicit CubicSpline(const Options& options) : options_(options) {}

  std::string why_declined(const Problem& problem) const override;

  /// Counts: `iterations` of the rotation solve. If no rotation spline through all keyframes
  /// exists, splines through parts of them are joined by great arcs, with the count `great_arcs`
  /// and a note. Short intervals (pose_runs.hpp) are bridged by chords, with a note.
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override;

 private:
  std::unique_ptr<const Curve> smooth_segment(const Trajectory& keyframes, Report& report) const;

  Options options_;
};

inline auto choices(CubicSpline::RotationMode) {
  return std::array{std::pair{"slerp", CubicSpline::RotationMode::slerp},
                    std::pair{"spline", CubicSpline::RotationMode::spline}};
}

template <class Visit>
void fields(CubicSpline::Options& o, Visit visit) {
  visit("rotation",
        o.rotation,
        "interpolation of rotation; slerp: great arcs; spline: C2 cumulative spline");
}

}  // namespace loopbench::methods
