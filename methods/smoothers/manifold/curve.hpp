/// Result of the manifold smoother: spline, planar pieces and heights as a function of time.
#pragma once

#include "datasets/core/curve.hpp"
#include "methods/smoothers/manifold/pieces.hpp"
#include "methods/smoothers/manifold/piecewise_curve.hpp"
#include "methods/smoothers/manifold/spatial.hpp"

namespace loopbench::methods::manifold {

struct Parts {
  Vector3 base;  ///< position of the first node [m]
  Vector3 up;
  NodeSpline spline;
  std::optional<PiecewiseCurve<PlanarPiece, Vector3>> planar;  ///< none: y' of the spline
  std::optional<PiecewiseCurve<Height, double>> spatial;       ///< none: z' of the spline

  /// Spline point with y' replaced by the planar piece, relative to `base`; `time` is a double or a
  /// Jet.
  template <class T>
  VectorOf<T> planar_point(std::size_t edge, const T& time) const {
    const SplinePointOf<T> position = spline.at(edge, time);
    if (!planar) return position.point;
    return planar->at(
        edge, time, [&](const PlanarPiece& piece) { return value_of_piece(piece, position); });
  }

  /// Point with y' and z' replaced.
  template <class T>
  VectorOf<T> point(std::size_t edge, const T& time) const {
    const VectorOf<T> out = planar_point(edge, time);
    if (!spatial) return out;
    const T own = along(up, out);
    const T height =
        spatial->at(edge, time, [&](const Height& piece) { return piece.over<T>(out, own); });
    return out + (height - own) * up;
  }
};

class ManifoldCurve final : public Curve {
 public:
  /// Requires at least two nodes. Orientation is the slerp of theirs.
  ManifoldCurve(const Trajectory& nodes, Parts parts);

  double start() const override { return stamps_.front(); }
  double end() const override { return stamps_.back(); }

  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override;

  const std::vector<double>& stamps() const { return stamps_; }
  const Parts& parts() const { return parts_; }

  /// Position [m], velocity and acceleration (analytic), evaluated with the pieces of `edge` even
  /// at its end points. Evaluating both edges of a node gives the jump there.
  MotionJet motion(std::size_t edge, double time) const;

 private:
  Rotation rotation(std::size_t edge, double time) const;

  struct RotationStep {
    Rotation start;
    Vector3 turn;  ///< rotation vector from `start` to the next node [rad]
  };
  std::vector<double> stamps_;
  std::vector<RotationStep> rotation_steps_;  ///< one per edge, so each logarithm is computed once
  Parts parts_;
};

}  // namespace loopbench::methods::manifold
